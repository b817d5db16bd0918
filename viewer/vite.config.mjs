import { readFileSync } from 'node:fs';
import { defineConfig } from 'vite';
import { lean_three } from './tools/lean_three.mjs';

const licence = (name) => readFileSync(new URL(`node_modules/${name}/LICENSE`, import.meta.url), 'utf8')
  .match(/^Copyright.*$/m)[0];
const mit = readFileSync(new URL('node_modules/three/LICENSE', import.meta.url), 'utf8').split('\n\n').slice(2).join('\n\n').trim();
// Reports are copies of these programs, so their licence goes along.
const banner = `/*! Anholon's viewer contains
three.js, ${licence('three')}
uPlot, ${licence('uplot')}
under the MIT License:
${mit}
*/`;

export default defineConfig({
  plugins: [lean_three()],
  define: { 'process.env.NODE_ENV': '"production"' },
  esbuild: { legalComments: 'none', charset: 'ascii' },
  build: {
    target: 'es2020',
    assetsInlineLimit: 10_000_000,
    lib: { entry: 'src/main.ts', name: 'anholon_viewer', formats: ['iife'], fileName: () => 'viewer.js' },
    rollupOptions: { output: { assetFileNames: 'viewer.[ext]', banner } },
    reportCompressedSize: false,
  },
});
