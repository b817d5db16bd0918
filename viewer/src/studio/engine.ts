// What the studio asks of the program: functions of a text and a case. The page knows no more of it, so a program compiled to WebAssembly
// can take the place of the one behind HTTP (http_engine.ts).

export interface Problem {
  severity: 'error' | 'warning' | 'note';
  message: string;
  hint: string;
  file: string;                            // empty: the text itself
  line: number; column: number; length: number;      // from 1, in characters; line 0: the text as a whole
}

export interface Trouble { text: string; hint: string; outcome: string; diagnostics: Problem[] }
export interface Replaced { replaced: true }         // a newer text came before the answer was ready
export interface Failed { error: Trouble }
export type Answer<T> = T | Replaced | Failed;
export const failed = <T>(a: Answer<T>): a is Failed => typeof a === 'object' && a !== null && 'error' in a;
export const replaced = <T>(a: Answer<T>): a is Replaced => typeof a === 'object' && a !== null && 'replaced' in a;

export interface Name { name: string; what: string }
export interface Checked { diagnostics: Problem[]; names: Name[]; cases: string[]; title: string; moves: boolean }
export interface Section { id: string; title: string; html: string }       // markup of the program, in which all text of the model is escaped
export interface Sections { sections: Section[] }
export interface Motion extends Sections { title: string; data: string }   // data: the JSON of CONTRACT.md
export interface CaseMotion extends Motion { number: number; command: string }    // of the case of a sweep; the command makes a page of it

// The text of a model and the scenario [case.NAME] that is applied to it; empty: none.
export interface Chosen { text: string; case_name: string }

export interface Engine {
  check(of: Chosen, edition: number): Promise<Answer<Checked>>;
  simulate(of: Chosen, edition: number): Promise<Answer<Motion>>;
  derive(of: Chosen, edition: number): Promise<Answer<Sections>>;
  prove(of: Chosen, edition: number): Promise<Answer<Sections>>;
  motion_of_case(number: number, edition: number): Promise<Answer<CaseMotion>>;      // of the sweep that was opened
}

// The map of a sweep: src/report/map.js reads it and is told what it says here in brief.
export interface SweepMap {
  title: string; shown: string; command: string; model: string; varied: string[];
  axes: { name: string; label: string }[];
  columns: { name: string; label: string; data: string; words: string[] }[];
  cells?: string;
  all: number; cases: number;              // rows in the folder; cases that the sweep is to have
  parts: number; all_parts: number;        // that are there, and that it is to have
  program: string; other_program: string;  // that made the folder; that computes its motions, if it is another one
}

export interface Key { name: string; meaning: string; choices: string[] }
export interface Language {
  sections: { name: string; form: 'top' | 'keys' | 'elements' | 'named' | 'part'; keys: Key[] }[];
  functions: { name: string; call: string; meaning: string }[];
  reserved: { name: string; meaning: string }[];
}

// Where the text comes from and goes to.
export interface Opened { name: string; text: string; hash: string; no_saving: string; version: string }
export interface Store {
  open(): Promise<Opened>;
  language(): Promise<Language>;
  sweep(): Promise<SweepMap | Failed>;
  // Asks first (`changed`) if the file is not the text that `open` or the last `save` gave or took.
  save(text: string, anyway: boolean): Promise<'saved' | { why: string; changed: boolean }>;
}
