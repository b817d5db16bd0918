// The choice among the scenarios [case.NAME] of a model; it is hidden while the model has none.

import { h } from '../dom.ts';

export class CaseChoice {
  private readonly select: HTMLSelectElement;
  readonly element: HTMLElement;

  constructor(changed: () => void) {
    this.select = h('select', { change: changed });
    this.element = h('label', { hidden: true }, 'case ', this.select);
  }

  // The name of the chosen case; empty for the file without a case.
  get chosen(): string { return this.select.value; }

  // Lists the cases of a text. The chosen one stays chosen.
  offer(cases: string[]): void {
    const { chosen } = this;
    const option = (name: string, text: string): HTMLElement => h('option', { value: name, selected: name === chosen }, text);
    this.select.replaceChildren(option('', 'none'), ...cases.map((name) => option(name, name)));
    this.element.hidden = cases.length === 0;
  }
}
