// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Bundles the page into a folder: index.html, app.css and app.js.
// Usage: node build.mjs [FOLDER]   (default: ../build/page)
import { build } from 'esbuild';
import { copyFile, mkdir, readFile } from 'node:fs/promises';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const output = resolve(process.argv[2] ?? join(here, '..', 'build', 'page'));
const three = join(here, 'node_modules', 'three');

/** The licence of three.js, which must be included in every copy. */
async function banner() {
  const { version } = JSON.parse(await readFile(join(three, 'package.json'), 'utf8'));
  const licence = (await readFile(join(three, 'LICENSE'), 'utf8')).trim();
  return [
    '/*!',
    'SPDX-FileCopyrightText: 2026 The adasplats authors',
    'SPDX-License-Identifier: Apache-2.0',
    '',
    `Contains three.js ${version}:`,
    '',
    licence,
    '*/',
  ].join('\n');
}

await mkdir(output, { recursive: true });
await build({
  entryPoints: [join(here, 'src', 'main.ts')],
  outfile: join(output, 'app.js'),
  bundle: true,
  format: 'iife',
  target: 'es2020',
  // Set here, so that a copy without tsconfig.json builds the same page.
  tsconfigRaw: {
    compilerOptions: { strict: true, target: 'es2020', useDefineForClassFields: false },
  },
  minify: true,
  charset: 'ascii',
  legalComments: 'inline',
  banner: { js: await banner() },
  logLevel: 'warning',
});
for (const name of ['index.html', 'app.css'])
  await copyFile(join(here, 'src', name), join(output, name));
