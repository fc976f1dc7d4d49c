// Runs in a page under test: returns unreadable texts.
(async () => {
  const wait = (time) => new Promise((done) => setTimeout(done, time));
  for (const folded of document.querySelectorAll("details")) folded.open = true;
  await wait(500);
  const seen = { smallest: Infinity, smallestText: "", identifiers: [], cut: [], backgrounds: [] };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    const text = node.textContent.trim();
    if (text === "" || element.closest("script, style, title, noscript, .hidden") || element.getClientRects().length === 0) continue;
    const svg = element.closest("svg");
    const scale = svg ? svg.getBoundingClientRect().width / svg.viewBox.baseVal.width : 1;
    const size = Number.parseFloat(getComputedStyle(element).fontSize) * scale;
    if (size < seen.smallest) [seen.smallest, seen.smallestText] = [size, text];
    // Descriptions of parameters are the author's.
    if (!element.closest("code, pre, .control small") && /\b[A-Za-z]+_[A-Za-z0-9_]+\b|`/.test(text)) seen.identifiers.push(text);
  }
  for (const command of document.querySelectorAll("dd pre")) {
    if (command.scrollWidth > command.clientWidth) seen.cut.push(command.textContent);
  }
  for (const svg of document.querySelectorAll("figure svg")) {
    if (svg.getClientRects().length > 0) seen.backgrounds.push(getComputedStyle(svg.querySelector("rect")).fill);
  }
  seen.page = getComputedStyle(document.body).backgroundColor;
  seen.excess = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  return seen;
})();
