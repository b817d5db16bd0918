// Inserts presentation MathML of the data into the page element by element. Readers need not trust the author of the data, so
// only markup of formulas is accepted, and no scripts.

const elements = new Set(['math', 'mrow', 'mi', 'mn', 'mo', 'ms', 'mtext', 'mspace', 'msub', 'msup', 'msubsup', 'mover', 'munder',
  'munderover', 'mfrac', 'msqrt', 'mroot', 'mtable', 'mtr', 'mtd', 'mstyle', 'mpadded', 'mphantom', 'mmultiscripts', 'mprescripts']);
const attributes = new Set(['display', 'displaystyle', 'scriptlevel', 'mathvariant', 'accent', 'accentunder', 'fence', 'separator',
  'form', 'stretchy', 'symmetric', 'largeop', 'movablelimits', 'lspace', 'rspace', 'width', 'height', 'depth', 'voffset',
  'linethickness', 'minsize', 'maxsize', 'columnalign', 'rowalign', 'columnspan', 'rowspan', 'dir']);
const space = 'http://www.w3.org/1998/Math/MathML';

function copied(source: Node): Node | null {
  if (source.nodeType === Node.TEXT_NODE) return document.createTextNode(source.textContent ?? '');
  if (!(source instanceof Element) || !elements.has(source.localName)) return null;
  const target = document.createElementNS(space, source.localName);
  for (const a of source.attributes) if (attributes.has(a.name)) target.setAttribute(a.name, a.value);
  for (const child of source.childNodes) {
    const c = copied(child);
    if (c) target.append(c);
  }
  return target;
}

// Returns the formula, or the plain name if there is no formula.
export function formula(html: string, name: string): Node {
  const math = html ? new DOMParser().parseFromString(html, 'text/html').querySelector('math') : null;
  return (math && copied(math)) ?? document.createTextNode(name);
}
