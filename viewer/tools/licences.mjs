// Writes dist/licences.txt: the licences of the libraries that are in what is built, from the packages themselves.

import { existsSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';

const modules = new URL('../node_modules/', import.meta.url);
const inside = ['three', 'uplot', '@fontsource/stix-two-math', ...['@codemirror', '@lezer', '@marijn'].flatMap((scope) =>
  (existsSync(new URL(scope, modules)) ? readdirSync(new URL(scope, modules)).map((name) => `${scope}/${name}`) : [])), 'style-mod', 'w3c-keyname', 'crelt'];
const texts = new Map();
for (const name of inside) {
  const { version } = JSON.parse(readFileSync(new URL(`${name}/package.json`, modules), 'utf8'));
  const text = readFileSync(new URL(`${name}/LICENSE`, modules), 'utf8').trim();
  texts.set(text, [...(texts.get(text) ?? []), `${name} ${version}`]);
}
writeFileSync(new URL('../dist/licences.txt', import.meta.url),
  `Libraries in the viewer of report pages, the widget of notebooks and the studio.\n\n${[...texts].map(([text, names]) => `${names.join(', ')}\n\n${text}\n`).join('\n----\n\n')}`);
