// Runs in a page under test: returns unreadable texts.

/** Widest column, px, that counts as narrow for text of several words. */
const NARROW_COLUMN = 120;

/** Returns the ink of an element with one character over its base line, px: [top, bottom] on the page. */
function ink(element) {
  const style = getComputedStyle(element);
  const context = document.createElement("canvas").getContext("2d");
  context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  let letter = element.textContent;
  // Browsers draw a single Latin letter as a mathematical one.
  if (element.tagName === "mi" && /^[a-z]$/.test(letter)) letter = String.fromCodePoint(0x1d44e + letter.charCodeAt(0) - 97);
  const measured = context.measureText(letter);
  const range = document.createRange();
  range.selectNodeContents(element);
  const base = range.getBoundingClientRect().top + measured.fontBoundingBoxAscent;
  return [base - measured.actualBoundingBoxAscent, base + measured.actualBoundingBoxDescent];
}

/** Largest overlap of the boxes of two texts, px; boxes are higher than the ink of their letters. */
const OVERLAP = 3;

/** Returns the pairs of overlapping texts. `texts`: text and box of each. */
function overlaps(texts) {
  const pairs = [];
  for (const [index, [text, a]] of texts.entries()) {
    for (const [other, b] of texts.slice(index + 1)) {
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (across > OVERLAP && down > OVERLAP) pairs.push([text, other]);
    }
  }
  return pairs;
}

/** Texts of the current picture of every canvas, by canvas. */
const written = new Map();

/** Records the texts that the page writes on canvases. A picture begins when its canvas is cleared. */
function recordCanvasTexts() {
  const { fillText, clearRect } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.clearRect = function (...arguments_) {
    written.set(this.canvas, []);
    return clearRect.apply(this, arguments_);
  };
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, widest) {
    const measured = this.measureText(text);
    const squeeze = Math.min(1, (widest ?? Infinity) / (measured.width || 1));
    const matrix = this.getTransform();
    const at = (dx, dy) => new DOMPoint(x + dx, y + dy).matrixTransform(matrix);
    const low = at(-measured.actualBoundingBoxLeft * squeeze, measured.actualBoundingBoxDescent);
    const high = at(measured.actualBoundingBoxRight * squeeze, -measured.actualBoundingBoxAscent);
    if (text !== "") written.get(this.canvas)?.push([text, { left: low.x, right: high.x, top: high.y, bottom: low.y }]);
    return fillText.call(this, text, x, y, ...(widest === undefined ? [] : [widest]));
  };
}

(async () => {
  recordCanvasTexts();
  const wait = (time) => new Promise((done) => setTimeout(done, time));
  for (const folded of document.querySelectorAll("details")) folded.open = true;
  await wait(2000);
  const seen = { smallest: Infinity, smallestText: "", identifiers: [], cut: [], fields: [], columns: [], dots: [], backgrounds: [] };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    const text = node.textContent.trim();
    if (text === "" || element.closest("script, style, title, noscript, .hidden") || element.getClientRects().length === 0) continue;
    const svg = element.closest("svg");
    const scale = svg ? svg.getBoundingClientRect().width / svg.viewBox.baseVal.width : 1;
    const size = Number.parseFloat(getComputedStyle(element).fontSize) * scale;
    if (size < seen.smallest) [seen.smallest, seen.smallestText] = [size, text];
    if (!element.closest("code, pre") && /\b[A-Za-z]+_[A-Za-z0-9_]+\b|`/.test(text)) seen.identifiers.push(text);
  }
  for (const command of document.querySelectorAll("dd pre, pre.changes")) {
    if (command.scrollWidth > command.clientWidth) seen.cut.push(command.textContent);
  }
  for (const field of document.querySelectorAll("input[type=number]")) {
    if (field.scrollWidth > field.clientWidth) seen.fields.push(field.value);
  }
  for (const cell of document.querySelectorAll("tbody th, tbody td, dd")) {
    const words = cell.querySelector("math, pre") ? [] : cell.textContent.trim().split(/\s+/);
    if (words.length > 5 && cell.clientWidth > 0 && cell.clientWidth < NARROW_COLUMN) seen.columns.push(cell.textContent);
  }
  for (const rate of document.querySelectorAll("mover")) {
    const [letter, dots] = rate.children;
    if (letter.textContent.length !== 1 || rate.getClientRects().length === 0) continue;
    const gap = ink(letter)[0] - ink(dots)[1];
    if (gap < 0.5) seen.dots.push([letter.textContent, gap]);
  }
  for (const svg of document.querySelectorAll("figure svg")) {
    if (svg.getClientRects().length > 0) seen.backgrounds.push(getComputedStyle(svg.querySelector("rect")).fill);
  }
  seen.overlaps = [...written.values()].flatMap(overlaps);
  for (const svg of document.querySelectorAll("figure svg")) {
    const texts = [...svg.querySelectorAll("text")].filter((text) => text.getClientRects().length > 0);
    seen.overlaps.push(...overlaps(texts.map((text) => [text.textContent, text.getBoundingClientRect()])));
  }
  seen.page = getComputedStyle(document.body).backgroundColor;
  seen.excess = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  return seen;
})();
