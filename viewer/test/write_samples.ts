import { write_page } from './page.ts';
import { car, decimated, disc, hostile, shapes, steady, wobbling } from './samples.ts';

const here = new URL('../', import.meta.url), dist = new URL('../dist/', here);
write_page(new URL('sample-disc.html', here), 'Disc rolling on a plane', [disc(wobbling(12), 12, 401), car()], dist);
write_page(new URL('sample-many.html', here), 'Ball on a turntable', [decimated(40), shapes()], dist);
write_page(new URL('sample-hostile.html', here), 'Hostile names', [hostile(), disc(steady, 10, 201)], dist);
