// Runs in a page without JavaScript: returns the visible elements that only a script makes useful.
(() => {
  const isVisible = (one) => one.getClientRects().length > 0;
  const dead = Array.from(document.querySelectorAll("canvas, button, #clock, #status")).filter(isVisible);
  return {
    dead: dead.map((one) => one.outerHTML),
    message: Array.from(document.querySelectorAll("noscript p")).some(isVisible),
    controls: document.querySelector(".controls").getBoundingClientRect().height,
  };
})();
