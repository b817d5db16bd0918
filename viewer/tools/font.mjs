// generated/math.woff2: the math font that viewer.css embeds, cut to our glyphs where fontTools is there.

import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, statSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const source = join(root, 'node_modules/@fontsource/stix-two-math/files/stix-two-math-latin-400-normal.woff2');
const target = join(root, 'generated/math.woff2');
mkdirSync(dirname(target), { recursive: true });

// Debian's own python first: python3-fonttools and python3-brotli are installed for it, and another may stand before it in PATH.
const subset = ['/usr/bin/python3', 'python3'].some((python) =>
  spawnSync(python, [join(root, 'tools/subset_font.py'), source, target], { stdio: ['ignore', 'inherit', 'ignore'] }).status === 0);
if (!subset) copyFileSync(source, target);
const size = `${Math.round(statSync(target).size / 1000)} kB`;
console.log(subset ? `math font: ${size}` : `math font: all of it, ${size}, since python3-fonttools and python3-brotli are missing`);
