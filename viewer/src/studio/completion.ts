// Completions at a place of a model file: sections, keys of a section, values of a key, functions and names of the model.

import type { Language, Name } from './engine.ts';

export interface Option { label: string; detail: string; kind: string; apply?: string }
export interface Offered { from: number; options: Option[] }      // from: the position in the text at which the word begins

const plain = (markdown: string): string => markdown.replace(/[`*]/g, '').replace(/\[([^\]]*)\]\([^)]*\)/g, '$1');

// Returns the section of a position, for example "body", or "" for the head of the file, with the fields that it has already.
export function section_at(text: string, position: number): { name: string; given: Set<string> } {
  let name = '';
  let given = new Set<string>();
  let at = 0;
  let inside = true;
  for (const line of text.split('\n')) {
    const header = /^\s*\[\[?\s*([A-Za-z0-9_.]+)/.exec(line);
    if (header && at > position) break;
    if (header) { inside = true; name = header[1]; given = new Set(); }
    const key = /^\s*([A-Za-z0-9_]+)\s*=/.exec(line);
    const here = at <= position && position <= at + line.length;
    if (key && inside && !here) given.add(key[1]);
    at += line.length + 1;
  }
  return { name: name.replace(/^case\.[^.]*\.?/, ''), given };
}

// Returns the names that the text declares in sections whose names the author chooses.
export function declared(text: string): Name[] {
  const list: Name[] = [];
  let name = '';
  for (const line of text.split('\n')) {
    const header = /^\s*\[\[?\s*([A-Za-z0-9_.]+)/.exec(line);
    if (header) name = header[1];
    const key = /^\s*([A-Za-z_][A-Za-z0-9_]*)\s*=/.exec(line);
    if (key && ['define', 'point', 'frame', 'parameters', 'functions', 'quasi'].includes(name)) list.push({ name: key[1], what: name });
  }
  return list;
}

export function offered(language: Language, names: Name[], text: string, position: number): Offered | null {
  const begin = text.lastIndexOf('\n', position - 1) + 1;
  const before = text.slice(begin, position);
  const word = /[A-Za-z_][A-Za-z0-9_.]*$/.exec(before)?.[0] ?? '';
  const from = position - word.length;
  if (/^[^"']*#/.test(before)) return null;
  // A header that is being written: [bo
  if (/^\s*\[\[?[A-Za-z0-9_.]*$/.test(before) && !/=/.test(before)) {
    const double = /^\s*\[\[/.test(before);
    const rest = text.slice(position).split('\n')[0];
    return {
      from, options: language.sections.filter((s) => s.form !== 'top' && s.form !== 'part' && (!double || s.form === 'elements')).map((s) => ({
        label: s.name, kind: 'namespace', detail: s.form === 'elements' ? `[[${s.name}]]` : `[${s.name}]`,
        apply: rest.includes(']') ? s.name : double || s.form !== 'elements' ? s.name + (double ? ']]' : ']') : `[${s.name}]]`,
      })),
    };
  }
  const { name, given } = section_at(text, position);
  const section = language.sections.find((s) => (name === '' ? s.form === 'top' : s.name === name));
  const key = /^\s*([A-Za-z0-9_]+)\s*=/.exec(before)?.[1];
  // A key at the beginning of a line.
  if (!key && /^\s*[A-Za-z0-9_]*$/.test(before)) {
    if (!section || section.form === 'named') return null;
    return { from, options: section.keys.filter((k) => !given.has(k.name)).map((k) => ({ label: k.name, kind: 'property', detail: plain(k.meaning), apply: `${k.name} = ` })) };
  }
  if (word === '' && !/["'(,+\-*/^=\s]$/.test(before)) return null;
  const choices = section?.keys.find((k) => k.name === key)?.choices ?? [];
  if (choices.length > 0) {
    const quoted = /["'][^"']*$/.test(before.slice(before.indexOf('=') + 1));
    return { from, options: choices.map((c) => ({ label: c, kind: 'enum', detail: '', apply: quoted ? c : `"${c}"` })) };
  }
  // A formula, within quotes.
  const value = before.slice(before.indexOf('=') + 1);
  if ((value.match(/"/g)?.length ?? 0) % 2 === 0) return null;
  const known = new Map<string, string>();
  for (const n of [...names, ...declared(text)]) if (!known.has(n.name)) known.set(n.name, n.what);
  return {
    from, options: [
      ...[...known].map(([label, detail]) => ({ label, kind: 'variable', detail })),
      ...language.functions.map((f) => ({ label: f.name, kind: 'function', detail: `${f.call}: ${plain(f.meaning)}`, apply: `${f.name}(` })),
      ...language.reserved.map((r) => ({ label: r.name, kind: 'constant', detail: plain(r.meaning) })),
    ],
  };
}
