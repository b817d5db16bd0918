// One WebGL context for the whole page. Every view has a 2D canvas of its own, into which its picture is copied: browsers
// allow only about sixteen contexts, and a 2D canvas can be printed and saved with its labels.

import { PCFShadowMap, WebGLRenderer, type Camera, type Scene } from 'three';

let renderer: WebGLRenderer | null | undefined;

export function gl(): WebGLRenderer | null {
  if (renderer !== undefined) return renderer;
  try {
    renderer = new WebGLRenderer({ alpha: true, antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(1);                 // sizes here are in device pixels
    renderer.setClearColor(0, 0);
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    renderer.domElement.addEventListener('webglcontextrestored', () => { for (const f of restored) f(); });
  } catch {
    renderer = null;
  }
  return renderer;
}

const restored = new Set<() => void>();
// Calls `f` when the context is restored. Returns the function that ends this.
export function on_restored(f: () => void): () => void {
  restored.add(f);
  return () => { restored.delete(f); };
}

let width = 0, height = 0;

export function paint(scene: Scene, camera: Camera, target: CanvasRenderingContext2D): void {
  const r = gl();
  const { canvas } = target;
  if (!r || canvas.width === 0 || canvas.height === 0) return;
  if (canvas.width > width || canvas.height > height) {
    width = Math.max(width, canvas.width);
    height = Math.max(height, canvas.height);
    r.setSize(width, height, false);
  }
  r.setViewport(0, 0, canvas.width, canvas.height);
  r.setScissor(0, 0, canvas.width, canvas.height);
  r.setScissorTest(true);
  r.render(scene, camera);
  target.clearRect(0, 0, canvas.width, canvas.height);
  target.drawImage(r.domElement, 0, height - canvas.height, canvas.width, canvas.height, 0, 0, canvas.width, canvas.height);
}
