// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Opens the page in headless Chromium and records faults.
import { accessSync, constants } from 'node:fs';
import { delimiter, join } from 'node:path';

const kFlags = [
  '--no-sandbox',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--disable-extensions',
  '--no-first-run',
  '--disable-default-apps',
  '--no-default-browser-check',
];

function isProgram(path) {
  try {
    accessSync(path, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}

/** Path of Chromium, or of the browser that CHROMIUM names. */
export function findBrowser() {
  const names = [process.env.CHROMIUM, 'chromium', 'chromium-browser', 'google-chrome'].filter(
    Boolean,
  );
  const folders = (process.env.PATH ?? '').split(delimiter);
  const places = names.flatMap((n) => (n.includes('/') ? [n] : folders.map((f) => join(f, n))));
  return places.find(isProgram);
}

/**
 * Returns {page, close(), faults: list that must stay empty, offline: whether connection errors are
 * expected}. `files`: a folder with a page that replaces the server's, or null; `prepare(page)` is
 * awaited before the page loads.
 */
export async function openPage(url, size, files = null, prepare = async () => {}) {
  const { chromium } = await import('playwright-core');
  // Chromium treats a replaced page as one of another origin.
  const flags = files ? [...kFlags, '--disable-features=LocalNetworkAccessChecks'] : kFlags;
  const browser = await chromium.launch({
    executablePath: findBrowser(),
    args: flags,
    timeout: 60_000,
  });
  const context = await browser.newContext({ viewport: size, acceptDownloads: true });
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  const page = await context.newPage();
  page.setDefaultTimeout(30_000);
  const seen = { page, faults: [], offline: false, close: () => browser.close() };
  const own = new URL(url);
  page.on('request', (request) => {
    const to = new URL(request.url());
    if (!['data:', 'blob:'].includes(to.protocol) && to.host !== own.host)
      seen.faults.push(`request to ${to}`);
  });
  page.on('pageerror', (error) => seen.faults.push(`exception: ${error.message}`));
  page.on('console', (message) => {
    if (!['error', 'warning'].includes(message.type())) return;
    const lost = /ERR_CONNECTION|WebSocket|Failed to load resource|ERR_EMPTY_RESPONSE/.test(
      message.text(),
    );
    // Chromium warns about reading pixels back without a GPU.
    if (/GPU stall due to ReadPixels|GroupMarkerNotSet/.test(message.text())) return;
    if (!(seen.offline && lost)) seen.faults.push(`console: ${message.text()}`);
  });
  for (const name of files ? ['app.js', 'app.css'] : [])
    await page.route(`${url}${name}`, (route) => route.fulfill({ path: join(files, name) }));
  if (files) await page.route(url, (route) => route.fulfill({ path: join(files, 'index.html') }));
  await prepare(page);
  await page.goto(url);
  return seen;
}
