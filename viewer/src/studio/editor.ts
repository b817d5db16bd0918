// The editor: CodeMirror with TOML, completion, and the program's messages under the lines that they concern.

import { acceptCompletion, autocompletion, completionKeymap, type CompletionContext, type CompletionResult } from '@codemirror/autocomplete';
import { defaultKeymap, history, historyKeymap } from '@codemirror/commands';
import { HighlightStyle, StreamLanguage, bracketMatching, syntaxHighlighting } from '@codemirror/language';
import { toml } from '@codemirror/legacy-modes/mode/toml';
import { lintGutter, lintKeymap, setDiagnostics, type Diagnostic } from '@codemirror/lint';
import { highlightSelectionMatches, searchKeymap } from '@codemirror/search';
import { EditorState } from '@codemirror/state';
import { EditorView, drawSelection, highlightActiveLine, keymap, lineNumbers } from '@codemirror/view';
import { tags } from '@lezer/highlight';
import { offered } from './completion.ts';
import type { Language, Name, Problem } from './engine.ts';

const colours = HighlightStyle.define([
  { tag: tags.comment, color: 'var(--quiet)', fontStyle: 'italic' },
  { tag: tags.string, color: 'var(--c2)' },
  { tag: [tags.number, tags.bool, tags.atom], color: 'var(--c3)' },
  { tag: [tags.propertyName, tags.keyword], color: 'var(--c0)' },
  { tag: tags.bracket, color: 'var(--c1)' },
]);

const look = EditorView.theme({
  '&': { height: '100%', fontSize: '.875rem', backgroundColor: 'var(--paper)', color: 'var(--ink)' },
  '.cm-scroller': { fontFamily: 'ui-monospace, "DejaVu Sans Mono", "Liberation Mono", monospace', lineHeight: '1.5' },
  '.cm-gutters': { backgroundColor: 'var(--panel)', color: 'var(--quiet)', borderRight: '1px solid var(--line)' },
  '.cm-activeLine, .cm-activeLineGutter': { backgroundColor: 'color-mix(in srgb, var(--accent) 4%, transparent)' },
  '.cm-content': { caretColor: 'var(--ink)' },
  '&.cm-focused .cm-cursor': { borderLeftColor: 'var(--ink)' },
  '&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground': { backgroundColor: 'color-mix(in srgb, var(--accent) 28%, transparent)' },
  '.cm-tooltip, .cm-panels': { backgroundColor: 'var(--panel)', color: 'var(--ink)', border: '1px solid var(--line)' },
  '.cm-tooltip-autocomplete ul li[aria-selected]': { backgroundColor: 'var(--accent)', color: 'var(--paper)' },
  '.cm-completionDetail': { fontStyle: 'normal', color: 'inherit', opacity: '.8', marginLeft: '.8em' },
});

// The TOML mode of CodeMirror ends a number before its exponent.
const model_text: typeof toml = { ...toml, token: (stream, state) => {
  const { inString, lhs, inArray } = state as { inString: boolean; lhs: boolean; inArray: number };
  const value = !inString && !lhs && !(stream.sol() && inArray === 0);
  return value && stream.match(/^[+-]?\d+(?:\.\d+)?[eE][+-]?\d+/) ? 'number' : toml.token(stream, state);
} };

export class Editor {
  readonly view: EditorView;
  language: Language = { sections: [], functions: [], reserved: [] };
  names: Name[] = [];

  constructor(place: HTMLElement, text: string, changed: () => void, save: () => void) {
    const complete = (context: CompletionContext): CompletionResult | null => {
      const found = offered(this.language, this.names, context.state.doc.toString(), context.pos);
      if (!found || (!context.explicit && found.from === context.pos)) return null;
      return {
        from: found.from, validFor: /^[A-Za-z0-9_.]*$/,
        options: found.options.map((o) => ({ label: o.label, type: o.kind, detail: o.detail.slice(0, 90), apply: o.apply })),
      };
    };
    this.view = new EditorView({
      parent: place,
      state: EditorState.create({
        doc: text,
        extensions: [
          lineNumbers(), lintGutter(), history(), drawSelection(), highlightActiveLine(), bracketMatching(), highlightSelectionMatches(),
          StreamLanguage.define(model_text), syntaxHighlighting(colours), look, EditorView.lineWrapping,
          autocompletion({ override: [complete], icons: false }),
          keymap.of([{ key: 'Mod-s', preventDefault: true, run: () => { save(); return true; } }, { key: 'Tab', run: acceptCompletion },
            ...completionKeymap, ...lintKeymap, ...searchKeymap, ...historyKeymap, ...defaultKeymap]),
          EditorView.contentAttributes.of({ 'aria-label': 'The model file', spellcheck: 'false', tabindex: '0' }),
          EditorView.updateListener.of((u) => { if (u.docChanged) changed(); }),
        ],
      }),
    });
  }

  get text(): string { return this.view.state.doc.toString(); }

  private position(line: number, column: number): number {
    const { doc } = this.view.state;
    if (line < 1) return 0;
    const l = doc.line(Math.min(line, doc.lines));
    return l.from + [...l.text].slice(0, Math.max(0, column - 1)).join('').length;      // columns count characters, not UTF-16 units
  }

  show(problems: Problem[]): void {
    const list: Diagnostic[] = problems.map((p) => {
      const own = p.file === '';
      const from = own ? this.position(p.line, p.column) : 0, to = own ? this.position(p.line, p.column + p.length) : 0;
      return {
        from, to: Math.max(from, to), severity: p.severity === 'note' ? 'info' : p.severity,
        message: (own ? '' : `${p.file}:${p.line}: `) + p.message + (p.hint ? `\nhint: ${p.hint}` : ''),
      };
    });
    this.view.dispatch(setDiagnostics(this.view.state, list));
  }

  go_to(p: Problem): void {
    this.view.dispatch({ selection: { anchor: this.position(p.line, p.column) }, scrollIntoView: true });
    this.view.focus();
  }
}
