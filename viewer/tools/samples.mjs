// Writes generated/sample-*.html, pages to look at.

import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));
mkdirSync('generated/test', { recursive: true });
await build({ entryPoints: ['test/write_samples.ts'], outfile: 'generated/test/write_samples.mjs', bundle: true, platform: 'node', format: 'esm' });
await import('../generated/test/write_samples.mjs');
