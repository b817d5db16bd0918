// Formulas that are wider than a sheet are printed smaller: --fit is the part of their size that fits (site.css).
"use strict";
addEventListener("beforeprint", () => {
  const sheet = 640;  // pixels of the text of a sheet of A4 or letter
  for (const box of document.querySelectorAll(".formula, .formula-scroll")) {
    const width = Math.max(...[...box.children].map(e => e.scrollWidth || e.getBoundingClientRect().width));
    if (width > sheet) box.style.setProperty("--fit", String(sheet / width));
  }
});
