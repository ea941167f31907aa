// Servers, plab-web and a browser for the tests of the page. Everything that is started here ends with end().
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import puppeteer from 'puppeteer-core';
import { Programs, readText, until } from './programs.mjs';

export { cpu, manyBodies, memory, readText, sleep, until } from './programs.mjs';

export class Lab extends Programs {
  constructor(bin) {
    super(bin);
    this.troubles = [];
  }

  async web(...args) {
    this.webProcess = this.start('plab-web', ...args);
    await until('plab-web prints its address', () => /http:\/\/\S+/.test(this.webProcess.text));
    this.url = this.webProcess.text.match(/http:\/\/\S+/)[0];
    return this.url;
  }

  // A program until it has ended: its exit code and all that it printed.
  async run(program, ...args) {
    const child = this.start(program, ...args);
    return { code: await child.ended, text: child.text };
  }

  statusOf(pid) {
    try {
      return readText(`/proc/${pid}/status`);
    } catch {
      return 'State:\tZ (gone)';
    }
  }

  async launch(chromium) {
    this.browser = await puppeteer.launch({
      executablePath: chromium, headless: true, pipe: true, userDataDir: join(this.folder, 'profile'),
      // The sandbox needs rights that root in a container has not; there is no graphics processor.
      args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage',
        '--disable-backgrounding-occluded-windows', '--disable-renderer-backgrounding'],
      protocolTimeout: 60000,
    });
  }

  // An empty page in a window of its own: a browser draws only the page in front of each window.
  async window() { return (await this.browser.createBrowserContext()).newPage(); }

  // A page that shows a scene of so many objects.
  async page(objects, width = 1280, height = 800, colours = 'light') {
    const page = await this.window();
    await page.setViewport({ width, height });
    await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: colours }]);
    page.on('pageerror', (error) => this.troubles.push(error.message));
    page.on('console', (message) => {
      if (message.type() === 'error' && !message.text().includes('WebSocket connection')) this.troubles.push(message.text());
    });
    await page.goto(this.url);
    await this.shows(page, objects);
    return page;
  }

  async shows(page, objects, ms = 30000) {
    await page.waitForFunction((n) => globalThis.plab?.model.objects.size === n && plab.model.state.kind === 'there' && plab.poses.newest !== null && plab.view.placed, { timeout: ms, polling: 50 }, objects);
  }

  async end() {
    await this.browser?.close();
    await super.end();
  }
}

// The processes that a process has started, and theirs.
export function processesUnder(pid) {
  const all = readdirSync('/proc').filter((name) => /^\d+$/.test(name)).flatMap((name) => {
    try {
      const [, state, parent] = /^\d+ \(.*\) (\S) (\d+)/s.exec(readText(`/proc/${name}/stat`));
      return [{ pid: Number(name), parent: Number(parent), state, command: readText(`/proc/${name}/cmdline`).replaceAll('\0', ' ') }];
    } catch {
      return []; // it has ended meanwhile
    }
  });
  const under = (parent) => all.filter((one) => one.parent === parent).flatMap((one) => [one, ...under(one.pid)]);
  return under(pid);
}

// Where an object is in the picture, in pixels of the page.
export const placeOf = (page, id) => page.evaluate((wanted) => {
  const { view } = plab, box = view.canvas.getBoundingClientRect();
  const at = view.camera.position.clone().set(...view.props.positionOf(wanted)).project(view.camera);
  return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
}, id);

// Colour of the picture at places of the page: read in the task that draws, for a browser keeps no drawn picture.
export const coloursAt = (page, places) => page.evaluate((wanted) => {
  const { view } = plab, box = view.canvas.getBoundingClientRect(), copy = document.createElement('canvas');
  view.renderer.render(view.scene, view.camera);
  copy.width = view.canvas.width;
  copy.height = view.canvas.height;
  const paint = copy.getContext('2d');
  paint.drawImage(view.canvas, 0, 0);
  return wanted.map(({ x, y }) => [...paint.getImageData(((x - box.left) / box.width) * copy.width, ((y - box.top) / box.height) * copy.height, 1, 1).data.slice(0, 3)]);
}, places);

// A sum over all pixels: differs when the picture does.
export const pictureSum = (page) => page.evaluate(() => {
  const { view } = plab, copy = document.createElement('canvas');
  view.renderer.render(view.scene, view.camera);
  copy.width = view.canvas.width;
  copy.height = view.canvas.height;
  const paint = copy.getContext('2d');
  paint.drawImage(view.canvas, 0, 0);
  let sum = 0;
  paint.getImageData(0, 0, copy.width, copy.height).data.forEach((value, i) => { sum = (sum * 31 + value * (i % 7919)) % 2147483647; });
  return sum;
});
