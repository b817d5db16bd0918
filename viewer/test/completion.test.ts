// What the studio's editor offers at a place of a model file.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { declared, offered, section_at } from '../src/studio/completion.ts';
import type { Language } from '../src/studio/engine.ts';

const language: Language = {
  sections: [
    { name: '', form: 'top', keys: [{ name: 'title', meaning: 'one line', choices: [] }] },
    { name: 'body', form: 'elements', keys: [{ name: 'mass', meaning: '', choices: [] }, { name: 'inertia', meaning: '', choices: [] }] },
    { name: 'define', form: 'named', keys: [] },
    { name: 'simulate', form: 'keys', keys: [{ name: 'method', meaning: '', choices: ['taylor', 'rk'] }] },
    { name: 'body.on', form: 'part', keys: [] },
  ],
  functions: [{ name: 'cos', call: 'cos(x)', meaning: 'the `cosine`' }],
  reserved: [{ name: 'pi', meaning: '' }],
};

// The labels that are offered at the mark |.
function at(marked: string): string[] | null {
  const position = marked.indexOf('|');
  return offered(language, [{ name: 'theta', what: 'coordinate' }], marked.replace('|', ''), position)?.options.map((o) => o.label) ?? null;
}

test('sections are offered after a bracket, elements alone after two', () => {
  assert.deepEqual(at('[|'), ['body', 'define', 'simulate']);
  assert.deepEqual(at('[[b|'), ['body']);
});

test('keys are those of the section that are not given yet', () => {
  assert.deepEqual(at('[[body]]\n|'), ['mass', 'inertia']);
  assert.deepEqual(at('[[body]]\nmass = 1\nin|'), ['inertia']);
  assert.deepEqual(at('[[body]]\nmass = 1\n[[body]]\n|'), ['mass', 'inertia'], 'another body has keys of its own');
  assert.deepEqual(at('t|'), ['title']);
  assert.equal(at('[define]\nx|'), null, 'names in [define] are the author\'s');
});

test('formulas get names of the model and functions; plain values and comments get nothing', () => {
  const all = at('[define]\ny = 1\n[[body]]\nmass = "2*|"');
  assert.deepEqual(all, ['theta', 'y', 'cos', 'pi']);
  assert.equal(at('[[body]]\nmass = 2|'), null);
  assert.equal(at('# th|'), null);
  assert.deepEqual(at('[simulate]\nmethod = "|"'), ['taylor', 'rk']);
});

test('the section of a position, and the names of a text', () => {
  assert.equal(section_at('a = 1\n[x]\nb = 2\n', 3).name, '');
  assert.equal(section_at('a = 1\n[x]\nb = 2\n', 12).name, 'x');
  assert.equal(section_at('[case.moon.body]\n', 17).name, 'body');
  assert.deepEqual(declared('[define]\nu = "x"\n[body]\nmass = 1\n').map((n) => n.name), ['u']);
});
