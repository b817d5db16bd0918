// three.js without what the viewer never uses: its renderer refers to every material's shader, to virtual reality and to
// environment maps, so bundlers keep them. Each name below must be found, or the build stops (three.js is pinned).

// Shader sources and chunks that only other materials than ours (basic, Phong, line, shadow) or textures need.
const chunks = ['lights_physical_pars_fragment', 'lights_physical_fragment', 'transmission_pars_fragment', 'transmission_fragment',
  'iridescence_fragment', 'iridescence_pars_fragment', 'envmap_physical_pars_fragment', 'lightprobes_pars_fragment', 'lights_toon_pars_fragment', 'lights_toon_fragment',
  'gradientmap_pars_fragment', 'lights_lambert_pars_fragment', 'lights_lambert_fragment', 'clearcoat_pars_fragment',
  'clearcoat_normal_fragment_begin', 'clearcoat_normal_fragment_maps', 'map_particle_fragment', 'map_particle_pars_fragment'];
const programs = ['background', 'backgroundCube', 'cube', 'equirect', 'linedashed', 'meshlambert', 'meshmatcap', 'meshnormal', 'meshphysical', 'meshtoon', 'points', 'sprite'];
const classes = {
  WebXRManager: `class WebXRManager extends EventDispatcher {
    constructor() { super(); this.enabled = false; this.isPresenting = false; this.cameraAutoUpdate = false; }
    getController() {} setAnimationLoop() {} addEventListener() {} removeEventListener() {} dispose() {}
    getDepthSensingMesh() { return null; } hasDepthSensing() { return false; } getEnvironmentBlendMode() {} }`,
  PMREMGenerator: 'class PMREMGenerator { dispose() {} }',
};

const without_notes = (glsl) => glsl
  .replace(/\/\*[\s\S]*?\*\//g, '').replace(/\/\/[^\n]*/g, '').replace(/[ \t]+/g, ' ').replace(/ ?\n[\s]*/g, '\n');

export function lean_three() {
  return {
    name: 'lean-three',
    transform(code, id) {
      if (!/\/three\/build\/three\.module\.js$/.test(id)) return null;
      const must = (name, next) => { if (next === code) throw new Error(`lean_three: ${name} is not in three.js as expected`); code = next; };
      for (const c of chunks) must(c, code.replace(new RegExp(`^((?:var|const) ${c} = )"(?:[^"\\\\]|\\\\.)*";`, 'm'), '$1"";'));
      for (const p of programs) {
        for (const stage of ['vert', 'frag']) {
          const name = code.match(new RegExp(`^\\t${p}_${stage}: ([\\w$]+),?$`, 'm'))?.[1];
          must(`${p}_${stage}`, name ? code.replace(new RegExp(`^(const ${name.replace('$', '\\$')} = )"(?:[^"\\\\]|\\\\.)*";`, 'm'), '$1"";') : code);
        }
      }
      for (const [name, stub] of Object.entries(classes)) {
        must(name, code.replace(new RegExp(`^class ${name} (extends \\w+ )?\\{[\\s\\S]*?^\\}`, 'm'), () => stub));
      }
      // Shaders are strings of one line here; their line ends are written out.
      code = code.replace(/^((?:var|const) [\w$]+ = )("(?:[^"\\]|\\.)*");$/gm, (all, head, text) =>
        text.length > 200 ? `${head}${JSON.stringify(without_notes(JSON.parse(text)))};` : all);
      return { code, map: null };
    },
  };
}
