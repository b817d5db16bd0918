// The button "copy LaTeX" beside each equation.

import { h, icon, set_icon } from './dom.ts';

async function to_clipboard(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return by_selection(text);        // pages from file:// may have no clipboard, or no permission to use it
  }
}

function by_selection(text: string): boolean {
  const area = h('textarea', { readonly: true, 'aria-hidden': 'true', style: 'position:fixed;top:0;left:-100vw' });
  area.value = text;
  const focused = document.activeElement;
  document.body.append(area);
  area.select();
  let done = false;
  try { done = document.execCommand('copy'); } catch { /* reported below */ }
  area.remove();
  if (focused instanceof HTMLElement) focused.focus({ preventScroll: true });
  return done;
}

function button_for(equation: HTMLElement): HTMLButtonElement {
  const word = h('span', { class: 'word', 'aria-live': 'polite' });
  const button = h('button', { type: 'button', class: 'copy-latex', 'aria-label': 'Copy LaTeX', title: 'Copy LaTeX' }, icon('copy'), word);
  let timer = 0;
  button.addEventListener('click', async () => {
    const done = await to_clipboard(equation.dataset.latex ?? '');
    word.textContent = done ? 'Copied' : 'Copying is not allowed here';
    set_icon(button, done ? 'done' : 'copy');
    button.classList.add('said');
    clearTimeout(timer);
    timer = window.setTimeout(() => { word.textContent = ''; set_icon(button, 'copy'); button.classList.remove('said'); }, 2000);
  });
  return button;
}

// Adds a button beside each equation, not inside, since the equation may scroll sideways.
export function add_copy_buttons(root: ParentNode = document): void {
  for (const equation of root.querySelectorAll<HTMLElement>('.equation[data-latex]')) {
    const button = button_for(equation);
    if (['TD', 'TH', 'LI'].includes(equation.tagName)) { equation.append(button); continue; }
    const row = h('div', { class: 'copyable' });
    equation.replaceWith(row);
    row.append(equation, button);
  }
}
