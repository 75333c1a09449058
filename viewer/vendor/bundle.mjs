// SPDX-License-Identifier: BSD-3-Clause
// Bundles a library of the live page: node bundle.mjs NAME FILE.  Of three.js it leaves out the texts of shaders that no
// material of the page uses.
import {readFile} from 'node:fs/promises';
import {build} from 'esbuild';

/** Shaders that the page uses by its materials and shadows, and parts that its own shaders include. */
const SHADERS = [
  'meshbasic_vert', 'meshbasic_frag', 'depth_vert', 'depth_frag', 'distance_vert', 'distance_frag', 'common', 'bsdfs',
  'lights_pars_begin', 'shadowmap_pars_vertex', 'shadowmap_vertex', 'shadowmap_pars_fragment',
  'shadowmask_pars_fragment', 'colorspace_fragment', 'colorspace_pars_fragment', 'tonemapping_pars_fragment'
];

/** Empties the entries of the table of shaders that are not needed; their texts are then dropped as unused. */
function dropShaders(source) {
  const table = /const ShaderChunk = \{\n([^}]*)\n\};/.exec(source);
  if (!table) throw new Error('three.js has no table ShaderChunk as this script knows it');
  const entries = [...table[1].matchAll(/^\t(\w+): ([\w$]+),?$/gm)].map(([, name, variable]) => [name, variable]);
  const texts = new Map(entries.map(([name, variable]) => {
    const at = source.indexOf(`const ${variable} = "`);
    return [name, source.slice(at, source.indexOf('\n', at))];
  }));
  const needed = new Set();
  const need = (name) => {
    if (needed.has(name) || !texts.has(name)) return;
    needed.add(name);
    for (const [, part] of texts.get(name).matchAll(/#include <(\w+)>/g)) need(part);
  };
  SHADERS.forEach(need);
  const kept = entries.map(([name, variable]) => `\t${name}: ${needed.has(name) ? variable : '\'\''}`).join(',\n');
  return source.replace(table[1], () => kept);
}

const [name, outfile] = process.argv.slice(2);
await build({
  entryPoints: [`${name}.js`],
  outfile,
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  legalComments: 'none',
  logLevel: 'error',
  plugins: [{
    name: 'shaders',
    setup: ({onLoad}) => onLoad({filter: /three\.module\.js$/}, async ({path}) => ({
      contents: dropShaders(await readFile(path, 'utf8')),
      loader: 'js',
    })),
  }],
});
