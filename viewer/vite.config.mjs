import { readFileSync } from 'node:fs';
import { transform } from 'esbuild';
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
const studio_banner = banner.replace("Anholon's viewer", "Anholon's studio").replace('uPlot,', `CodeMirror, ${licence('@codemirror/view')}\nLezer, ${licence('@lezer/common')}\nuPlot,`);

// Three programs: the script of a page; (--mode widget) the module of a notebook's widget, which has its style inside; (--mode studio)
// the page of the studio.
const programs = {
  production: { entry: 'src/main.ts', name: 'anholon_viewer', formats: ['iife'], fileName: () => 'viewer.js' },
  studio: { entry: 'src/studio/main.ts', name: 'anholon_studio', formats: ['iife'], fileName: () => 'studio.js' },
  widget: { entry: 'src/widget.ts', formats: ['es'], fileName: () => 'widget.js' },
};

// Vite leaves modules of libraries readable; ours is no library.
const minified = {
  name: 'minified',
  async renderChunk(code) {
    const small = await transform(code, { minify: true, format: 'esm', target: 'es2020', legalComments: 'none', charset: 'ascii' });
    return { code: `${banner}\n${small.code}`, map: null };
  },
};

export default defineConfig(({ mode }) => ({
  plugins: [lean_three(), ...(mode === 'widget' ? [minified] : [])],
  define: { 'process.env.NODE_ENV': '"production"' },
  esbuild: { legalComments: 'none', charset: 'ascii' },
  build: {
    target: 'es2020',
    assetsInlineLimit: 10_000_000,
    lib: programs[mode],
    emptyOutDir: mode === 'production',
    rollupOptions: { output: { assetFileNames: mode === 'studio' ? 'studio.[ext]' : 'viewer.[ext]', banner: mode === 'widget' ? '' : mode === 'studio' ? studio_banner : banner } },
    reportCompressedSize: false,
  },
}));
