// The page of plab-web in a real browser: page_test.mjs BIN SCENES CHROMIUM PICTURES
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { coloursAt, Lab, manyBodies, pictureSum, placeOf, sleep, until } from './lab.mjs';

const [bin, scenes, chromium, pictures] = process.argv.slice(2);
const kObjects = 8; // of the paper's scene
const lab = new Lab(bin);
let server, page;

const shot = (of, name) => of.screenshot({ path: join(pictures, `${name}.png`) });
const ask = (of, operation) => of.evaluate((o) => plab.socket.request(o), operation);
const serverOf = (of) => of.evaluate(() => plab.model.server);
const typeOf = (of, id) => of.evaluate((wanted) => plab.model.interactions.get(wanted).type, id);

before(async () => {
  server = await lab.server(join(scenes, 'fan_and_balloons.xml'), '--rate', 'real');
  await lab.web();
  await lab.launch(chromium);
  page = await lab.page(kObjects);
  await page.evaluate(() => { plab.view.judgedAt = Infinity; }); // pictures stay as fine as they are, however slow the machine is
});
after(() => lab.end());

test('what is drawn is where it is, in its colours, and moves', async () => {
  await ask(page, { verb: 'reset' });
  await until('the run began anew', async () => (await serverOf(page)).run === 2);
  await ask(page, { verb: 'pause' });
  await sleep(1500);
  const places = [await placeOf(page, 'red'), await placeOf(page, 'green'), await placeOf(page, 'small_gear')];
  const box = await page.evaluate(() => plab.view.canvas.getBoundingClientRect().toJSON());
  places.push({ x: box.left + box.width / 2, y: box.bottom - 5 });
  const [red, green, gear, nothing] = await coloursAt(page, places);
  assert.ok(red[0] > 2 * red[1] && red[0] > 2 * red[2], `the red balloon is ${red}`);
  assert.ok(green[1] > 1.5 * green[0] && green[1] > 1.5 * green[2], `the green balloon is ${green}`);
  assert.ok(gear[0] > 1.5 * gear[2], `the small gear is ${gear}`);
  assert.ok(Math.min(...nothing) > 150, `where nothing is: ${nothing}`);
  const still = await pictureSum(page);
  await sleep(300);
  assert.equal(await pictureSum(page), still, 'a paused scene does not move');
  await ask(page, { verb: 'step', argument: '100' });
  await until('the picture changes', async () => (await pictureSum(page)) !== still);
  // Poses in the page are those that the server says.
  await sleep(500);
  const shown = await page.evaluate(() => [...plab.view.props.positionOf('red')]);
  const said = (await lab.control('watch', 'states', '-n', '1')).bodies.red.position;
  said.forEach((value, i) => assert.ok(Math.abs(value - shown[i]) < 1e-6 * (1 + Math.abs(value)), `red is at ${shown}, not at ${said}`));
});

test('pause, step, rate and reset', async () => {
  await ask(page, { verb: 'pause' });
  const { step } = await serverOf(page);
  await page.$eval('#steps', (input) => { input.value = '10'; });
  await page.click('#step');
  await until('ten steps are made', async () => (await serverOf(page)).step === step + 10);
  await page.click('#pause');
  await until('it goes on', async () => !(await serverOf(page)).paused);
  await page.select('#rate', '0.5');
  await until('the rate is half', async () => (await serverOf(page)).rate_asked === 0.5);
  await page.select('#rate', 'real');
  const { run } = await serverOf(page);
  await page.click('#reset');
  await until('a new run begins', async () => (await serverOf(page)).run === run + 1);
});

test('a preview says what an exchange would do, and does nothing', async () => {
  await until('the motor turns', async () => (await serverOf(page)).time > 0.5);
  const { revision } = await serverOf(page);
  await page.evaluate(() => plab.model.select('gears'));
  await page.waitForSelector('[data-preview="Constraint/AngularVelocity/Assign"]:enabled');
  await page.click('[data-preview="Constraint/AngularVelocity/Assign"]');
  const card = await (await page.waitForSelector('.card')).evaluate((element) => element.innerText);
  assert.match(card, /If it were Assign/);
  assert.match(card, /the energy higher by [-.\de]+ J/);
  assert.equal((await serverOf(page)).revision, revision);
  await page.evaluate(() => plab.model.select(null));
});

// Clicks TYPE of the selected interaction. On a busy machine a trial may exceed its budget; then nothing was measured, the card has to say
// so, and the exchange is made back and once more.
async function exchangeWithProof(id, type) {
  const before = await typeOf(page, id);
  for (let attempt = 0; attempt < 10; ++attempt) {
    await page.waitForSelector(`[data-type="${type}"]:enabled`);
    await page.click(`[data-type="${type}"]`);
    const text = await (await page.waitForSelector('.card')).evaluate((element) => element.innerText);
    const cells = await page.$$eval('.card tbody tr:first-child td', (all) => all.map((cell) => cell.textContent));
    if (/Trial: made/.test(text)) return { text, cells: cells.map(Number) };
    assert.match(text, /Trial: given up after .* \(budget .*\)/);
    assert.deepEqual(cells, ['–', '–', '–']);
    await ask(page, { verb: 'swap', target: id, argument: before });
    await page.evaluate(() => plab.model.select(null));
    await until('it is exchanged back', async () => (await typeOf(page, id)) === before);
    await page.evaluate((wanted) => plab.model.select(wanted), id);
  }
  assert.fail(`ten trials of ${type} exceeded their budget`);
}

test('two clicks exchange the gears, and a card says what that did', async () => {
  await until('the motor turns', async () => (await serverOf(page)).time > 1);
  const row = await page.evaluate(() => [...document.querySelectorAll('[role=treeitem]')].find((e) => e.querySelector('.name')?.textContent === 'gears').getBoundingClientRect().toJSON());
  await page.mouse.click(row.x + 40, row.y + row.height / 2);
  const { text: card, cells: [old, fresh, jump] } = await exchangeWithProof('gears', 'Constraint/AngularVelocity/Assign');
  assert.match(card, /Graph → Assign/);
  assert.match(card, /energy/);
  assert.match(card, /The loop stood still for/);
  assert.ok(old > 0 && fresh > old && Math.abs(fresh - old - jump) < 1e-3, `the energy is ${old}, ${fresh}, ${jump}: Assign makes some up`);
  assert.equal(await typeOf(page, 'gears'), 'Constraint/AngularVelocity/Assign');
  const list = await lab.control('interactions');
  assert.match(JSON.stringify(list), /Constraint\/AngularVelocity\/Assign/);
  await page.evaluate(() => plab.plots.add('fan.speed'));
  await sleep(1200);
  await shot(page, 'web');
});

test('a refusal is a sentence, and changes nothing', async () => {
  const { revision } = await serverOf(page);
  await page.evaluate(() => plab.model.select('gears'));
  const input = await page.waitForSelector('#parameter-velocity_factor');
  await input.evaluate((element) => { element.value = 'banana'; });
  await input.press('Enter');
  const text = await (await page.waitForSelector('#trouble p')).evaluate((element) => element.textContent);
  assert.match(text, /The server refused this: .*velocity_factor/);
  assert.equal((await serverOf(page)).revision, revision);
  await input.evaluate((element) => { element.value = '-0.25'; });
  await input.press('Enter');
  await until('the parameter is set', () => page.evaluate(() => plab.model.details.get('gears')?.find((p) => p.name === 'velocity_factor')?.text === '-0.25'));
});

test('a click in the picture selects', async () => {
  await ask(page, { verb: 'reset' });
  await until('it is at its beginning', () => page.evaluate(() => plab.poses.newest.time < 1));
  await ask(page, { verb: 'pause' });
  await sleep(500);
  const { x, y } = await placeOf(page, 'red');
  await page.mouse.click(x, y);
  assert.equal(await page.evaluate(() => plab.model.selected), 'red');
  await page.waitForFunction(() => document.querySelector('#details h2')?.textContent === 'red');
  await ask(page, { verb: 'resume' });
});

test('a body is grabbed by the mouse, carried and let go', async () => {
  await sleep(200);
  const { x, y } = await placeOf(page, 'green');
  const height = () => page.evaluate(() => plab.view.props.positionOf('green')[2]);
  const start = await height();
  await page.keyboard.down('Shift');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await until('the scene has a hand', () => page.evaluate(() => [...plab.model.interactions.keys()].some((id) => id.startsWith('web_grab'))));
  await page.mouse.move(x, y - 60, { steps: 10 });
  await until('it follows the hand', async () => (await height()) > start + 0.15);
  await page.mouse.up();
  await page.keyboard.up('Shift');
  await until('the hand is gone', () => page.evaluate(() => ![...plab.model.objects.keys()].some((id) => id.startsWith('web_grab'))));
});

test('the line of time goes back', async () => {
  await until('two seconds have passed', async () => (await serverOf(page)).time > 2);
  await page.$eval('#time', (input) => {
    input.value = '1';
    input.dispatchEvent(new Event('input'));
    input.dispatchEvent(new Event('change'));
  });
  await until('it is a second into the run', () => page.evaluate(() => plab.poses.newest.time < 1.6 && plab.model.server.time < 1.9));
});

test('a moment is kept, and returned to', async () => {
  await page.click('#keep');
  const kept = await until('the server has it', async () => (await serverOf(page)).snapshots.find((one) => one.name === 'moment-1'));
  await until('time goes on', async () => (await serverOf(page)).time > kept.time + 1);
  await page.select('#snapshots', 'moment-1');
  await until('it is back there', () => page.evaluate((time) => plab.model.server.time < time + 0.8, kept.time));
});

test('two pages see the same', async () => {
  await ask(page, { verb: 'reset' }); // the rewind has brought the hand back
  await until('all is as at the beginning', () => page.evaluate((n) => plab.model.objects.size === n, kObjects));
  const other = await lab.page(kObjects, 420, 860, 'dark');
  await ask(other, { verb: 'swap', target: 'gears', argument: 'Constraint/AngularVelocity/Impulse' });
  for (const of of [page, other]) await until('the swap is seen', async () => (await typeOf(of, 'gears')) === 'Constraint/AngularVelocity/Impulse');
  // A phone's width: nothing is cut off, and dark is dark.
  await sleep(800);
  assert.ok(await other.evaluate(() => document.scrollingElement.scrollWidth <= innerWidth), 'nothing is wider than the phone');
  assert.ok(await other.evaluate(() => parseInt(getComputedStyle(document.body).backgroundColor.match(/\d+/)[0], 10) < 60));
  await shot(other, 'web-phone');
  await other.close();
});

test('everything can be named and reached by keys', async () => {
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, textarea, canvas, [role=tree]')]
    .filter((e) => !e.closest('.uplot') && !e.textContent.trim() && !e.getAttribute('aria-label') && !e.labels?.length && e.getAttribute('aria-hidden') !== 'true').map((e) => e.outerHTML));
  assert.deepEqual(nameless, []);
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('Space');
  await until('the space bar pauses', async () => (await serverOf(page)).paused);
  await page.keyboard.press('Space');
  await page.keyboard.press('/');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'filter');
  await page.keyboard.type('wind');
  await page.focus('#tree');
  for (const key of ['Home', 'ArrowDown', 'Enter']) await page.keyboard.press(key);
  assert.equal(await page.evaluate(() => plab.model.selected), 'wind');
  await page.$eval('#filter', (input) => {
    input.value = '';
    input.dispatchEvent(new Event('input'));
  });
});

test('events are listed', async () => {
  await page.click('[data-tab=events]');
  await until('the swaps are in the list', () => page.$eval('#events', (list) => list.innerText.includes('request.swap')));
  await shot(page, 'web-events');
  await page.click('[data-tab=plots]');
});

test('a killed server is noticed, and its successor shown', async () => {
  server.kill('SIGKILL');
  await server.ended;
  await until('the page says so', () => page.evaluate(() => plab.model.state.kind !== 'there' && !document.querySelector('#state').hidden));
  const scene = join(lab.folder, 'many.xml');
  writeFileSync(scene, manyBodies(10000));
  server = await lab.server(scene, '--rate', 'real');
  const begin = Date.now();
  await lab.shows(page, 10000);
  console.log(`the successor, with 10,000 bodies, is shown after ${Date.now() - begin} ms`);
  assert.ok(await page.evaluate(() => document.querySelector('#state').hidden));
});

test('ten thousand bodies move', async () => {
  await page.evaluate(() => {
    plab.view.judgedAt = null; // what is too slow may be given up from here on
    plab.view.fitAll();
  });
  await sleep(8000);
  const measure = () => page.evaluate(() => ({ pictures: plab.view.pictures, poses: plab.poses.received, bytes: plab.socket.bytes, at: performance.now(), time: plab.poses.newest.time }));
  const a = await measure();
  await sleep(5000);
  const b = await measure(), seconds = (b.at - a.at) / 1000;
  const place = await page.evaluate(() => {
    const begin = performance.now();
    for (let i = 0; i < 50; ++i) {
      plab.view.props.place(plab.poses.between(performance.now()));
      plab.view.props.show(plab.view.eye(), false);
    }
    return (performance.now() - begin) / 50;
  });
  console.log(`10,000 bodies, drawn by software: ${((b.pictures - a.pictures) / seconds).toFixed(1)} pictures/s, ${((b.poses - a.poses) / seconds).toFixed(1)} messages of poses/s, ${((b.bytes - a.bytes) / seconds / 1e6).toFixed(2)} MB/s; the page's own part of a picture takes ${place.toFixed(2)} ms`);
  assert.ok(b.pictures > a.pictures + 3 && b.time > a.time);
  assert.ok(place < 50, 'twenty pictures a second leave 50 ms for each');
  // Of the tree only the rows that are seen exist.
  assert.ok((await page.$$eval('#tree .row', (rows) => rows.length)) < 80);
  await shot(page, 'web-many');
});

test('a page that is opened before the server waits for it', async () => {
  server.kill('SIGTERM');
  await server.ended;
  const early = await lab.window();
  await early.goto(lab.url);
  await until('it says what it waits for', () => early.evaluate(() => /server/.test(document.querySelector('#state').textContent)));
  server = await lab.server(join(scenes, 'fan_and_balloons.xml'), '--rate', 'real');
  await lab.shows(early, kObjects);
  await early.close();
});

test('who runs at which level of detail is listed, with its cost', async () => {
  server.kill('SIGTERM');
  await server.ended;
  server = await lab.server(join(scenes, 'levels', 'budget.xml'), '--rate', 'real');
  await until('the governor has chosen', () => page.evaluate(() => !document.querySelector('[data-tab=levels]').hidden), 30000);
  await page.click('[data-tab=levels]');
  const rows = await until('levels are listed', () => page.$$eval('#levels tbody tr', (all) => all.map((row) => [...row.children].map((cell) => cell.textContent))).then((all) => all.length > 0 && all));
  const listed = await lab.control('levels');
  const total = rows.reduce((sum, row) => sum + Number(row[3]), 0);
  assert.equal(total, listed.levels.length, `${JSON.stringify(rows)} against ${JSON.stringify(listed).slice(0, 400)}`);
  for (const row of rows) assert.match(row[1], /^[1-9] of [1-9]$/);
  await page.click('[data-tab=plots]');
});

test('no page had an error', () => assert.deepEqual(lab.troubles, []));
