// What CONTRACT.md promises of dist/: no address that could be fetched, nothing that ends an inline script or style, a size.

import { readFileSync, statSync } from 'node:fs';

const limit = 700_000;
const faults = [];
let total = 0;
for (const name of ['viewer.js', 'viewer.css', 'widget.js', 'studio.js', 'studio.css']) {
  const bytes = readFileSync(new URL(`../dist/${name}`, import.meta.url));
  const text = bytes.toString('utf8');
  if (name.startsWith('viewer.')) total += bytes.length;
  if (name === 'widget.js' && /\bimport\s*[({"'*]/.test(text)) faults.push(`${name} imports`);
  for (const [address] of text.matchAll(/(?:https?|wss?|ftp):\/\/[^\s"'`)]*/gi)) {
    if (!/^http:\/\/www\.w3\.org\/(1999\/xhtml|2000\/svg|1998\/Math\/MathML)$/.test(address)) faults.push(`${name} holds the address ${address}`);
  }
  for (const mark of ['</script', '<script', '<!--', '</style']) if (text.toLowerCase().includes(mark)) faults.push(`${name} holds ${mark}`);
  for (const [, url] of text.matchAll(/url\(\s*["']?([^"')]{0,40})/g)) {
    if (!/^(viewer|studio)\.js$/.test(name) && !/^(data:|\$|#)/.test(url)) faults.push(`${name} loads ${url}`);
  }
  if (/@import\b/.test(text) && name.endsWith('.css')) faults.push(`${name} imports`);
  console.log(`${name}: ${(bytes.length / 1000).toFixed(1)} kB`);
}
// The whole math font, where fontTools is missing, is allowed and said by tools/font.mjs.
const subset = statSync(new URL('../generated/math.woff2', import.meta.url)).size < 100_000;
if (total > limit && subset) faults.push(`${total} bytes are more than ${limit}`);
for (const f of faults) console.error(`dist: ${f}`);
process.exit(faults.length > 0 ? 1 : 0);
