// Presentation MathML of the data, put into the page element by element. The data of a page are its author's; whoever
// reads it should not have to trust them with scripts, so nothing but formula markup passes.

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

// The formula, or the plain name where there is none.
export function formula(html: string, name: string): Node {
  const math = html ? new DOMParser().parseFromString(html, 'text/html').querySelector('math') : null;
  return (math && copied(math)) ?? document.createTextNode(name);
}
