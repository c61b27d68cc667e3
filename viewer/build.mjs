// Makes template.html from src: bundles the scripts with three.js, minifies, and inlines everything. The same sources and
// the same locked packages give the same bytes. `--check` compares instead of writing.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build, transform } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const read = (name) => readFileSync(join(here, name), 'utf8');

const bundle = await build({
  absWorkingDir: here, entryPoints: ['src/main.js'], bundle: true, minify: true, write: false, format: 'iife', target: 'es2022',
  charset: 'utf8', legalComments: 'none',
});
const style = await transform(read('src/style.css'), { loader: 'css', minify: true, charset: 'utf8' });

// Of everything that the result is made from: a test without node compares this.
const sources = [...readdirSync(join(here, 'src')).sort().map((name) => `src/${name}`), 'build.mjs', 'package.json', 'package-lock.json'];
const digest = createHash('sha256');
for (const name of sources) digest.update(`${name}\n`).update(read(name));

const three = JSON.parse(read('node_modules/three/package.json')).version;
const licences = [
  'Made by Certa. The viewer is part of it: GPL-3.0-or-later; its sources are in the folder viewer of Certa.',
  `Sources: sha256 ${digest.digest('hex')}`,
  '',
  `The page contains three.js ${three}:`,
  '',
  read('node_modules/three/LICENSE').trim(),
].join('\n');

const parts = { licences, style: style.code.trim(), script: bundle.outputFiles[0].text.trim() };
const page = read('src/page.html').replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
if (page.split('<!--certa:data-->').length !== 2) throw new Error('the place of the data must occur once');
if (/\)certa_page"/.test(page)) throw new Error('the template would end its string literal');

if (process.argv.includes('--check')) {
  if (page !== read('template.html')) {
    console.error('template.html is not what its sources give: run npm run build');
    process.exit(1);
  }
  console.log('template.html is what its sources give');
} else {
  writeFileSync(join(here, 'template.html'), page);
  console.log(`template.html: ${Buffer.byteLength(page)} bytes`);
}
