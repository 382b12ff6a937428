// Bundles the viewer into the asset that the Rust crate embeds in every report.
import { build } from 'esbuild';
import { readFile } from 'node:fs/promises';

const licence = await readFile(new URL('node_modules/three/LICENSE', import.meta.url), 'utf8');
const { version } = JSON.parse(await readFile(new URL('node_modules/three/package.json', import.meta.url), 'utf8'));

await build({
  entryPoints: [new URL('src/main.js', import.meta.url).pathname],
  outfile: new URL('../crates/homeo/src/export/viewer.js', import.meta.url).pathname,
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'none',
  banner: {
    js: `/* Generated from viewer/ by scripts/build-viewer; do not edit.\n\nContains three.js ${version}.\n\n${licence.trim()}\n*/`,
  },
});
