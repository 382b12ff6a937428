// Opens a report in Chromium and checks that it draws, that controls act and that nothing goes to the network.
// Usage: node test/check-page.mjs REPORT.html…   (CHROMIUM names the browser, default `chromium`)

import { strict as assert } from 'node:assert';
import { existsSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const SOFTWARE_GL = ['--no-sandbox', '--disable-gpu', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic'];
const NO_GL = ['--no-sandbox', '--disable-gpu', '--disable-3d-apis', '--disable-quic'];

function browserPath() {
  if (process.env.CHROMIUM) return process.env.CHROMIUM;
  const folders = (process.env.PATH ?? '').split(':');
  const found = folders.map((folder) => `${folder}/chromium`).find((path) => existsSync(path));
  assert.ok(found, 'set CHROMIUM to the path of a Chromium browser');
  return found;
}

/** A page that records what went wrong. Performance hints of software rendering are no errors. */
async function open(browser, file, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1400, height: 900 }, ...options });
  const problems = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || (message.type() === 'warning' && !/ReadPixels|Automatic fallback/.test(message.text()))) problems.push(message.text());
  });
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) problems.push(`asked for ${request.url()}`);
  });
  await page.goto(pathToFileURL(resolve(file)).href);
  return { page, problems };
}

/** A small copy of the canvas. */
async function canvasPixels(page) {
  return page.evaluate(() => {
    const canvas = document.querySelector('.views canvas');
    window.homeoReport.views.draw();
    const small = Object.assign(document.createElement('canvas'), { width: 200, height: 100 });
    const context = small.getContext('2d');
    context.drawImage(canvas, 0, 0, 200, 100);
    return Array.from(context.getImageData(0, 0, 200, 100).data);
  });
}

/** Mean difference of two pictures of the canvas, as a share of full brightness. */
function difference(a, b) {
  return a.reduce((sum, value, index) => sum + Math.abs(value - b[index]), 0) / (255 * a.length);
}

async function expectChange(page, what, action) {
  const before = await canvasPixels(page);
  await action();
  const change = difference(before, await canvasPixels(page));
  assert.ok(change > 0.0005, `${what} changed nothing (${change})`);
}

async function checkControls(page) {
  const pixels = await canvasPixels(page);
  const drawn = pixels.filter((_, index) => index % 4 === 3).filter((alpha) => alpha > 0).length;
  assert.ok(drawn > 1500, `only ${drawn} of 20000 pixels are drawn`);
  const presets = await page.locator('[data-preset]').evaluateAll((buttons) => buttons.map((button) => button.dataset.preset));
  for (const name of [...presets.slice(1), presets[0]]) {
    await expectChange(page, `preset ${name}`, () => page.click(`[data-preset=${name}]`));
    assert.equal(await page.getAttribute(`[data-preset=${name}]`, 'aria-pressed'), 'true');
  }
  await expectChange(page, 'mesh edges', () => page.check('input[name=edges]'));
  await expectChange(page, 'opacity', () => page.fill('input[name=opacity]', '0.4'));
  await expectChange(page, 'level sets', () => page.selectOption('select[name=coordinate]', 'all'));
  if (await page.locator('input[name=allLevels]').count()) {
    await expectChange(page, 'one level', () => page.uncheck('input[name=allLevels]'));
    await expectChange(page, 'level slider', () => page.fill('input[name=level]', '6'));
  } else {
    await expectChange(page, 'one layer', () => page.selectOption('select[name=coordinate]', 'bottom'));
  }
  await expectChange(page, 'leaves', () => page.check('input[name=leaves]'));
  await expectChange(page, 'cut', () => page.selectOption('select[name=cut]', 'target y'));
  await expectChange(page, 'cut position', () => page.fill('input[name=cutAt]', '0.3'));
  await expectChange(page, 'cut side', () => page.check('input[name=cutFlip]'));
  await expectChange(page, 'morph', () => page.fill('input[name=morph]', '0.5'));
  await page.fill('input[name=morph]', '0');
  await expectChange(page, 'surface again', () => page.click('[data-preset=surface]'));
  await expectChange(page, 'arrow key', async () => {
    await page.focus('.stage');
    await page.keyboard.press('ArrowLeft');
  });
  await expectChange(page, 'reset', () => page.click('text=Reset view'));
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('text=Save picture')]);
  assert.equal(download.suggestedFilename(), 'homeo-map.png');
}

/** The image that is found for a point of the target is that point itself. */
async function checkPicking(page) {
  const box = await page.locator('.stage').nth(1).boundingBox();
  await page.mouse.move(box.x + box.width * 0.45, box.y + box.height * 0.55);
  await page.mouse.move(box.x + box.width * 0.45 + 1, box.y + box.height * 0.55);
  await page.waitForFunction(() => document.querySelectorAll('.readout')[0].textContent.includes('x ='));
  const error = await page.evaluate(() => {
    const { probe, views, model } = window.homeoReport;
    const { hit } = probe;
    // Project the found image: it must lie under the pointer.
    const seen = probe.project(views.panes[1]);
    const ring = probe.rings[0].hidden;
    return { ring, x: seen.x, y: seen.y, inside: hit.image.every((share) => share >= -0.001 && share <= 1.001), target: model.data.target };
  });
  assert.equal(error.ring, false);
  assert.ok(error.inside, 'the image lies in the frame of the target');
  assert.ok(Math.hypot(error.x - box.width * 0.45 - 1, error.y - box.height * 0.55) < 2.5, `found point is seen elsewhere: ${JSON.stringify(error)}`);
}

async function checkNarrow(browser, file) {
  const { page, problems } = await open(browser, file, { viewport: { width: 390, height: 844 }, colorScheme: 'dark' });
  await page.waitForSelector('html[data-viewer=ready]');
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(overflow <= 0, `the page is ${overflow} pixels too wide on a phone`);
  assert.deepEqual(problems, []);
  await page.close();
}

async function checkWithoutWebgl(executablePath, file) {
  const browser = await chromium.launch({ executablePath, args: NO_GL });
  const { page } = await open(browser, file);
  await page.waitForSelector('.no-picture[role=status]');
  assert.match(await page.textContent('.no-picture'), /WebGL 2/);
  assert.ok(await page.isVisible('.verdict'));
  assert.ok(await page.isVisible('#facts'));
  await browser.close();
}

const files = process.argv.slice(2);
assert.ok(files.length > 0, 'name at least one report');
const executablePath = browserPath();
const browser = await chromium.launch({ executablePath, args: SOFTWARE_GL });
for (const file of files) {
  const { page, problems } = await open(browser, file);
  await page.waitForSelector('html[data-viewer=ready]');
  await checkControls(page);
  await checkPicking(page);
  assert.deepEqual(problems, []);
  await page.close();
  await checkNarrow(browser, file);
  await checkWithoutWebgl(executablePath, file);
  console.log(`ok ${file}`);
}
await browser.close();
