// Puts page.html, the style, the bundled script and licences together: node build.mjs OUTPUT
// The result lacks only what the program fills in: @TITLE@ and @SCENE@.
import {createHash} from 'node:crypto';
import {readFileSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {build} from 'esbuild';

const folder = dirname(fileURLToPath(import.meta.url));
const read = (...names) => readFileSync(join(folder, ...names), 'utf8');
const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

const bundle = await build({
  absWorkingDir: folder,
  entryPoints: ['src/main.js'],
  bundle: true,
  minify: true,
  write: false,
  format: 'iife',
  target: 'es2022',
  legalComments: 'none',
});
// A string of the bundle that ends a script would end the page's.
const script = bundle.outputFiles[0].text.trim().replaceAll('</script', '<\\/script');
const style = read('src', 'style.css').trim();
const licence = read('node_modules', 'three', 'LICENSE').trim();
const three = JSON.parse(read('node_modules', 'three', 'package.json')).version;

const parts = {
  POLICY: [
    `default-src 'none'`, `script-src ${hash(script)}`, `style-src ${hash(style)}`,
    `base-uri 'none'`, `form-action 'none'`,
  ].join('; '),
  STYLE: style,
  SCRIPT: script,
  LICENCE: `three.js ${three}\n\n${licence}`,
};
const page = read('src', 'page.html').replace(/@(POLICY|STYLE|SCRIPT|LICENCE)@/g, (_, k) => parts[k]);
writeFileSync(process.argv[2], page);
writeFileSync(process.argv[2] + '.licence', parts.LICENCE + '\n');
