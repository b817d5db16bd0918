// Bundles test/*.test.ts for node and runs them.

import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const root = fileURLToPath(new URL('..', import.meta.url));
process.chdir(root);
if (!existsSync('dist/viewer.js')) { console.error('dist/ is not there: npm run build'); process.exit(1); }
mkdirSync('generated/test', { recursive: true });
const tests = readdirSync('test').filter((f) => f.endsWith('.test.ts'));
await build({
  entryPoints: tests.map((f) => `test/${f}`), outdir: 'generated/test', outExtension: { '.js': '.mjs' },
  bundle: true, platform: 'node', format: 'esm', target: 'node18', external: ['playwright-core'], logLevel: 'warning',
});
const runs = [['tools/check_dist.mjs'], ['--test', ...tests.map((f) => `generated/test/${f.replace(/\.ts$/, '.mjs')}`)]];
process.exit(Math.max(...runs.map((args) => spawnSync(process.execPath, args, { stdio: 'inherit' }).status ?? 1)));
