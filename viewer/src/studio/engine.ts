// The functions of the program that the studio calls with a text and a case. The page uses the program only by them, so a program
// compiled to WebAssembly can replace the one behind HTTP (http_engine.ts).

export interface Problem {
  severity: 'error' | 'warning' | 'note';
  message: string;
  hint: string;
  file: string;                            // empty for the text itself
  line: number; column: number; length: number;      // from 1, in characters; line 0 stands for the whole text
}

export interface Trouble { text: string; hint: string; outcome: string; diagnostics: Problem[] }
export interface Replaced { replaced: true }         // a newer text came before the answer was ready
export interface Failed { error: Trouble }
export type Answer<T> = T | Replaced | Failed;
export const failed = <T>(a: Answer<T>): a is Failed => typeof a === 'object' && a !== null && 'error' in a;
export const replaced = <T>(a: Answer<T>): a is Replaced => typeof a === 'object' && a !== null && 'replaced' in a;

export interface Name { name: string; what: string }
export interface Checked { diagnostics: Problem[]; names: Name[]; cases: string[]; title: string; moves: boolean }
export interface Section { id: string; title: string; html: string }       // markup by the program, which escapes all text of the model
export interface Sections { sections: Section[] }
export interface Motion extends Sections { title: string; data: string }   // data: the JSON of CONTRACT.md
export interface CaseMotion extends Motion { number: number; command: string }    // the number of the case; a command that makes its page

// The text of a model, and the scenario [case.NAME] that is applied to it; empty for none.
export interface Chosen { text: string; case_name: string }

export interface Engine {
  check(of: Chosen, edition: number): Promise<Answer<Checked>>;
  simulate(of: Chosen, edition: number): Promise<Answer<Motion>>;
  derive(of: Chosen, edition: number): Promise<Answer<Sections>>;
  prove(of: Chosen, edition: number): Promise<Answer<Sections>>;
  motion_of_case(number: number, edition: number): Promise<Answer<CaseMotion>>;      // a case of the sweep that was opened
}

// The map of a sweep, which src/report/map.js reads.
export interface SweepMap {
  title: string; shown: string; command: string; model: string; varied: string[];
  axes: { name: string; label: string }[];
  columns: { name: string; label: string; data: string; words: string[] }[];
  cells?: string;
  all: number; cases: number;              // rows in the folder; cases that the sweep is to have
  parts: number; all_parts: number;        // complete parts; parts that the sweep is to have
  program: string; other_program: string;  // the program that made the folder; the one that computes motions, if they differ
}

export interface Key { name: string; meaning: string; choices: string[] }
export interface Language {
  sections: { name: string; form: 'top' | 'keys' | 'elements' | 'named' | 'part'; keys: Key[] }[];
  functions: { name: string; call: string; meaning: string }[];
  reserved: { name: string; meaning: string }[];
}

// The place from which the text is opened and to which it is saved.
export interface Opened { name: string; text: string; hash: string; no_saving: string; version: string }
export interface Store {
  open(): Promise<Opened>;
  language(): Promise<Language>;
  sweep(): Promise<SweepMap | Failed>;
  // Saves nothing and answers `changed` if the file was changed since `open` or the last `save`, unless `anyway` is true.
  save(text: string, anyway: boolean): Promise<'saved' | { why: string; changed: boolean }>;
}
