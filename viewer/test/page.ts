// A report page around sample data, with a page style such as the C++ side writes.

import { readFileSync, writeFileSync } from 'node:fs';
import type { RawCase, RawReport } from '../src/data.ts';

const page_css = `
:root { --paper:#fffefb; --ink:#1c1c1a; --quiet:#6a6963; --line:#dedcd4; --accent:#1f5fa8; --warn:#b3261e; --panel:#f6f5f0;
  --c0:#1f5fa8; --c1:#c2571a; --c2:#2e7d4f; --c3:#8e3b8a; --c4:#a98600; --c5:#0f7c8a; --c6:#a23b3b; --c7:#5f6368; }
:root[data-theme="dark"] { --paper:#16171a; --ink:#e8e6e0; --quiet:#9c9a93; --line:#35363b; --accent:#7fb2f0; --warn:#f0897f; --panel:#1d1f23;
  --c0:#7fb2f0; --c1:#f0a06a; --c2:#78c79a; --c3:#d29be0; --c4:#e0c35a; --c5:#67c6d4; --c6:#ee8d8d; --c7:#b0b3b8; }
@media (prefers-color-scheme: dark) { :root:not([data-theme="light"]) { --paper:#16171a; --ink:#e8e6e0; --quiet:#9c9a93; --line:#35363b; --accent:#7fb2f0; --warn:#f0897f; --panel:#1d1f23;
  --c0:#7fb2f0; --c1:#f0a06a; --c2:#78c79a; --c3:#d29be0; --c4:#e0c35a; --c5:#67c6d4; --c6:#ee8d8d; --c7:#b0b3b8; } }
html { background: var(--paper); color: var(--ink); font: 1.0625rem/1.6 Georgia, 'DejaVu Serif', serif; }
body { max-width: 66rem; margin: 0 auto; padding: 2rem 1.25rem 5rem; }
header.page { display: flex; justify-content: space-between; align-items: start; gap: 1rem; }
h1 { font-weight: 500; line-height: 1.2; margin: 0; } h2 { font-weight: 500; margin: 3rem 0 1rem; overflow-wrap: anywhere; }
math { font-family: "Anholon Math", math; } .equation { overflow-x: auto; padding: .5rem 0; } mtd { padding: .25em .5em; }`;

const escape = (s: string): string => s.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/"/g, '&quot;');

const equation = `<div class="equation" data-latex="\\dot{x} = -R\\,\\dot{\\varphi}\\cos\\psi"><math display="block"><mi>x</mi><mo lspace="0" rspace="0">\u2032</mo>
<mo>=</mo><mo>\u2212</mo><mi>R</mi><msqrt><mrow><mn>1</mn><mo>+</mo><mfrac><msup><mi>\u03b8</mi><mn>2</mn></msup><mn>4</mn></mfrac></mrow></msqrt><mo>(</mo><mtable><mtr><mtd><mi>cos</mi><mspace width="0.1667em"/><mi>\u03c8</mi></mtd></mtr>
<mtr><mtd><mi>sin</mi><mspace width="0.1667em"/><mi>\u03c8</mi></mtd></mtr><mtr><mtd><mn>0</mn></mtd></mtr></mtable><mo>)</mo></math></div>`;

export function page(title: string, cases: RawCase[], dist: URL, before = ''): string {
  const raw: RawReport = { format: 1, title, cases };
  const data = JSON.stringify(raw).replace(/</g, '\\u003c');
  const read = (name: string): string => readFileSync(new URL(name, dist), 'utf8');
  const parts = cases.map((c, k) => `<h2>${escape(c.name || title)}</h2><div class="player" data-case="${k}"><p>The motion is shown where scripts run.</p></div>
<h2>Results</h2><div class="plots" data-case="${k}"><div class="static"><svg width="100" height="50"></svg></div></div>`);
  return `<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1"><title>${escape(title)}</title>
<style>${page_css}</style><style>${read('viewer.css')}</style></head><body><header class="page"><h1>${escape(title)}</h1><div class="tools"></div></header>
<p>A disc rolls on a plane without slipping.</p>${equation}${parts.join('\n')}
<script type="application/json" id="anholon-data">${data}</script><script>${before}</script><script>${read('viewer.js')}</script></body></html>`;
}

export function write_page(path: URL, title: string, cases: RawCase[], dist: URL, before = ''): string {
  writeFileSync(path, page(title, cases, dist, before));
  return path.href;
}
