// Recordings, playbacks and branches from the page of plab-web: recording_test.mjs BIN SCENES CHROMIUM PICTURES
import assert from 'node:assert/strict';
import { existsSync, readdirSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Lab, manyBodies, pictureSum, processesUnder, sleep, until } from './lab.mjs';

const [bin, scenes, chromium, pictures] = process.argv.slice(2);
const kObjects = 8; // of the paper's scene
const lab = new Lab(bin);
const folder = join(lab.folder, 'runs');
let page;

const shot = (of, name) => of.screenshot({ path: join(pictures, `${name}.png`) });
const ask = (of, operation) => of.evaluate((o) => plab.socket.request(o), operation);
const job = (of, verb, name = '', value = 0) => of.evaluate((...words) => plab.jobs.ask(...words), verb, name, value);
const serverOf = (of) => of.evaluate(() => plab.model.server);
const playback = (of) => of.evaluate(() => plab.model.playback);
const placeOfRed = (of) => of.evaluate(() => [...plab.view.props.positionOf('red')]);
const textOf = (of, id) => of.$eval(id, (element) => element.innerText);
const troubleOf = (of) => of.evaluate(() => [...document.querySelectorAll('#trouble p')].map((p) => p.textContent).join(' | '));
const clear = (of) => of.evaluate(() => document.querySelectorAll('#trouble p, #notes p').forEach((p) => p.remove()));
const click = async (of, selector) => (await of.waitForSelector(`${selector}:enabled`)).click();
// As a person drags the handle and lets go of it.
const drag = (of, time) => of.$eval('#time', (input, value) => {
  input.value = String(value);
  for (const kind of ['input', 'change']) input.dispatchEvent(new Event(kind));
}, time);
const programs = () => processesUnder(lab.webProcess.pid).map((one) => one.command);

before(async () => {
  await lab.server(join(scenes, 'fan_and_balloons.xml'), '--rate', 'real');
  await lab.web();
  await lab.launch(chromium);
});
after(() => lab.end());

test('without a folder the page says how recording is turned on, and records nothing', async () => {
  page = await lab.page(kObjects);
  await click(page, '#record');
  assert.match(await textOf(page, '#recordings'), /Recording is off\. Start plab-web with --recordings DIR/);
  for (const [verb, name] of [['record', 'a'], ['play', 'a'], ['delete', 'a']]) {
    const reply = await job(page, verb, name);
    assert.equal(reply.outcome, 'refused');
    assert.match(reply.reasons[0], /--recordings DIR/);
  }
  await page.close();
  lab.webProcess.kill('SIGTERM');
  await lab.webProcess.ended;
});

test('a run is recorded by keys, and listed with its length', async () => {
  await lab.web('--recordings', folder);
  page = await lab.page(kObjects);
  await page.evaluate(() => { plab.view.judgedAt = Infinity; });
  await until('the balloon moves', async () => (await serverOf(page)).time > 1.5);
  await page.focus('[data-tab=recordings]');
  await page.keyboard.press('Enter');
  await page.focus('#record-name');
  await page.keyboard.type('first');
  await page.keyboard.press('Enter');
  await until('it records', async () => /Stop recording/.test(await textOf(page, '#record')));
  assert.equal((await job(page, 'record', 'second')).outcome, 'refused', 'one at a time');
  await until('three seconds are recorded', () => page.evaluate(() => plab.jobs.jobs.recording?.seconds >= 3));
  assert.match(await textOf(page, '#recordings-list'), /first.*being recorded/s);
  await click(page, '#record');
  const row = await until('its length is listed', async () => /first\s.*?(\d+\.\d) s/s.exec(await textOf(page, '#recordings-list')));
  assert.ok(Number(row[1]) > 2.5 && Number(row[1]) < 8, `it is ${row[1]} s long`);
  assert.deepEqual(readdirSync(folder), ['first.mcap']);
  await until('its process has ended', () => programs().length === 0);
});

test('names lead nowhere but to the folder', async () => {
  writeFileSync(join(lab.folder, 'secret.mcap'), 'not for pages');
  symlinkSync(join(lab.folder, 'secret.mcap'), join(folder, 'link.mcap'));
  for (const name of ['../evil', 'a/b', '/tmp/evil', '..', '.hidden', '-o', 'a b', 'ä', 'x'.repeat(65), 'a\u0000b'])
    for (const verb of ['record', 'play', 'delete']) {
      const reply = await job(page, verb, name);
      assert.equal(reply.outcome, 'refused', `${verb} ${name}`);
      assert.match(reply.reasons[0], /is no name of a recording/);
    }
  for (const verb of ['play', 'delete']) assert.match((await job(page, verb, 'link')).reasons[0], /there is no recording 'link'/);
  assert.match((await job(page, 'record', 'first')).reasons[0], /there is a recording 'first' already/);
  assert.match((await job(page, 'play', 'nothing')).reasons[0], /there is no recording 'nothing'/);
  assert.match((await job(page, 'dance')).reasons[0], /nothing that plab-web can do/);
  assert.ok(!existsSync(join(lab.folder, 'evil.mcap')));
  assert.deepEqual(readdirSync(folder).sort(), ['first.mcap', 'link.mcap']);
  assert.ok(!/link/.test(await textOf(page, '#recordings-list')), 'a link is no recording');
  // In the page it is a sentence.
  await page.$eval('#record-name', (input) => { input.value = 'a/b'; });
  await click(page, '#record-now');
  await until('the page says so', async () => /This was not done: 'a\/b' is no name of a recording/.test(await troubleOf(page)));
  await page.$eval('#record-name', (input) => { input.value = ''; });
  await clear(page);
});

test('a recording is played, and the line of time goes to any moment of it', async () => {
  await click(page, '[data-play=first]');
  await until('the playback is there', async () => (await serverOf(page))?.name === 'play-first');
  await lab.shows(page, kObjects);
  assert.match(await textOf(page, '#elsewhere'), /Recording first: .*Back to lab/s);
  assert.ok(!/false|null|undefined/.test(await textOf(page, '#elsewhere')));
  await until('it plays', async () => (await playback(page))?.at > (await playback(page)).from);
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('Space');
  await until('the space bar pauses it', async () => (await playback(page)).paused);
  const { from, to } = await playback(page);
  const settled = async (time) => {
    await drag(page, time);
    await until(`it is at ${time}`, async () => Math.abs((await playback(page)).at - time) < 0.01);
    await sleep(700);
    return { picture: await pictureSum(page), red: await placeOfRed(page), time: await page.evaluate(() => plab.poses.newest.time) };
  };
  const early = await settled(from + 0.3), late = await settled(to - 0.1), again = await settled(from + 0.3);
  assert.notEqual(early.picture, late.picture, 'another moment is another picture');
  assert.ok(late.time > early.time + 1.5, `${late.time} is later than ${early.time}`);
  assert.deepEqual(again.red, early.red);
  assert.equal(again.time, early.time);
  assert.match(await textOf(page, '#time-text'), /^0\.300 s of \d/);
  // It is no server that could be changed.
  assert.match((await ask(page, { verb: 'push', target: 'red', values: { impulse: '1 0 0' } })).reasons[0], /this is a playback/);
  assert.deepEqual(await page.evaluate(() => ['step', 'reset', 'keep', 'branch', 'record', 'grab', 'push'].filter((id) => !document.getElementById(id).disabled)), []);
  await page.select('#rate', '2');
  await until('it is told its rate', async () => (await playback(page)).rate === 2);
  await shot(page, 'web-recording');
  await click(page, '#pause');
  await until('at its end it waits', async () => (await playback(page)).at === to && (await playback(page)).paused, 20000);
  await page.select('#rate', 'real');
  await click(page, '#pause');
  await until('and begins anew', async () => (await playback(page)).at < to - 0.5 && !(await playback(page)).paused);
  assert.match((await job(page, 'delete', 'first')).reasons[0], /is being played/);
});

test('one click goes back to the server, and the playback ends', async () => {
  assert.equal(programs().filter((command) => command.includes(' play ')).length, 1);
  await click(page, '#back');
  await until('it is the server again', async () => (await serverOf(page))?.name === 'lab');
  await lab.shows(page, kObjects);
  await until('the playback is gone', () => programs().length === 0);
  assert.equal(await page.evaluate(() => plab.model.playback), null);
  assert.ok(await page.$eval('#elsewhere', (element) => element.hidden));
});

test('a playback that nobody looks at any more ends by itself', async () => {
  const other = await lab.page(kObjects);
  const { server } = await job(other, 'play', 'first');
  await other.evaluate((name) => plab.jobs.look(name), server);
  await until('it is there', async () => (await serverOf(other))?.name === server);
  await other.close();
  await until('it ends', () => programs().length === 0, 20000);
});

test('a branch goes on by itself, and ends from the page', async () => {
  await page.bringToFront();
  await click(page, '#pause');
  await until('it is paused', async () => (await serverOf(page)).paused);
  const moment = (await serverOf(page)).time;
  await click(page, '#branch');
  await until('the branch is there', async () => (await serverOf(page))?.name === 'branch-1', 40000);
  await lab.shows(page, kObjects);
  const there = await serverOf(page);
  assert.ok(there.paused && Math.abs(there.time - moment) < 1e-9, `it begins at ${there.time}, paused, as the server is at ${moment}`);
  assert.deepEqual(await page.$$eval('#shown option', (options) => options.map((o) => o.textContent)), ['lab', 'branch-1 (branch of lab)']);
  await ask(page, { verb: 'swap', target: 'gears', argument: 'Constraint/AngularVelocity/Assign' });
  await click(page, '#step');
  await until('it steps', async () => (await serverOf(page)).time > moment);
  const list = await lab.control('--server', 'lab', 'interactions');
  assert.match(JSON.stringify(list), /Constraint\/AngularVelocity\/Graph/, 'the server has its own gears still');
  // The address with the name shows it in a second page, beside the server.
  const url = lab.url;
  lab.url = `${url}#branch-1`;
  const other = await lab.page(kObjects);
  lab.url = url;
  await until('another page shows it', async () => (await serverOf(other))?.name === 'branch-1');
  await page.select('#shown', '');
  await until('the server is shown again', async () => (await serverOf(page))?.name === 'lab');
  assert.equal((await serverOf(other)).name, 'branch-1', 'each page looks where it wants');
  assert.deepEqual(processesUnder(lab.webProcess.pid).filter((one) => one.state === 'Z'), []);
  await click(other, '#end-branch');
  await until('it is the server', async () => (await serverOf(other))?.name === 'lab');
  await until('its processes are gone', () => programs().length === 0);
  await until('the choice is gone', () => page.$eval('#choice', (element) => element.hidden));
  await other.close();
  await click(page, '#pause');
});

test('branches are bounded, and one that ends by itself is told', async () => {
  for (let i = 0; i < 4; ++i) assert.equal((await job(page, 'branch')).outcome, 'done');
  assert.match((await job(page, 'branch')).reasons[0], /there are 4 branches/);
  await page.evaluate(() => plab.jobs.look('branch-2'));
  await until('it is shown', async () => (await serverOf(page))?.name === 'branch-2');
  await ask(page, { verb: 'shutdown' });
  await until('the page says so', async () => /Branch branch-2 has ended/.test(await troubleOf(page)));
  await until('and shows the server', async () => (await serverOf(page))?.name === 'lab');
  for (const name of ['branch-1', 'branch-3', 'branch-4']) assert.equal((await job(page, 'end', name)).outcome, 'done');
  await until('all are gone', () => programs().length === 0);
  await clear(page);
});

test('a phone shows the recordings, and everything has a name', async () => {
  const phone = await lab.page(kObjects, 420, 860, 'dark');
  await click(phone, '[data-tab=recordings]');
  await until('the list is there', async () => /first/.test(await textOf(phone, '#recordings-list')));
  assert.ok(await phone.evaluate(() => document.scrollingElement.scrollWidth <= innerWidth), 'nothing is wider than the phone');
  const nameless = await phone.evaluate(() => [...document.querySelectorAll('button, input, select, meter')]
    .filter((e) => !e.closest('.uplot') && !e.textContent.trim() && !e.getAttribute('aria-label') && !e.labels?.length && e.getAttribute('aria-hidden') !== 'true').map((e) => e.outerHTML));
  assert.deepEqual(nameless, []);
  await shot(phone, 'web-recordings-phone');
  await phone.close();
});

test('a recording is deleted by two presses', async () => {
  assert.equal((await job(page, 'record', 'short')).outcome, 'done');
  await sleep(500);
  assert.match((await job(page, 'delete', 'short')).reasons[0], /is being recorded/);
  assert.equal((await job(page, 'stop')).outcome, 'done');
  await click(page, '[data-tab=recordings]');
  await click(page, '[data-delete=short]');
  await until('it asks again', async () => /Really delete/.test(await textOf(page, '#recordings-list')));
  assert.ok(existsSync(join(folder, 'short.mcap')));
  await click(page, '[data-delete=short]');
  await until('it is gone', () => !existsSync(join(folder, 'short.mcap')));
});

test('when plab-web is killed nothing that it started goes on, and the recording is whole', async () => {
  assert.equal((await job(page, 'record', 'cut')).outcome, 'done');
  assert.equal((await job(page, 'branch', 'side')).outcome, 'done');
  const { server } = await job(page, 'play', 'first');
  await page.evaluate((name) => plab.jobs.look(name), server);
  await until('it is shown', async () => (await serverOf(page))?.name === server);
  const started = processesUnder(lab.webProcess.pid);
  for (const [what, count] of [['record', 1], ['branch', 1], ['play', 1]]) assert.equal(started.filter((one) => one.command.includes(` ${what} `)).length, count, what);
  assert.ok(started.some((one) => /plabd /.test(one.command)), 'the branch is a server');
  await sleep(1000);
  lab.webProcess.kill('SIGKILL');
  await lab.webProcess.ended;
  const stillThere = () => started.filter(({ pid }) => existsSync(`/proc/${pid}`) && !/^State:\s+Z/m.test(lab.statusOf(pid)));
  await until('all of them have ended', () => stillThere().length === 0, 8000);
  const told = await lab.run('plabctl', 'info', join(folder, 'cut.mcap'));
  assert.equal(told.code, 0, told.text);
  assert.ok(!/not closed|was not closed|recover/.test(told.text), told.text);
  await until('the page says that it is gone', () => page.evaluate(() => plab.model.state.kind === 'lost'));
  await page.close();
});

test('a recording ends at the limit, which the page shows', async () => {
  const scene = join(lab.folder, 'many.xml'), small = join(lab.folder, 'small');
  writeFileSync(scene, manyBodies(1000));
  const many = lab.start('plabd', scene, '--name', 'many', '--rate', 'real');
  await until('plabd is ready', () => many.text.includes('ready after'));
  await lab.web('--server', 'many', '--recordings', small, '--recordings-limit', '2');
  page = await lab.page(1000);
  await click(page, '#record');
  await until('the page says that it is full', async () => /has ended: the recordings have the 2 MB that they may have/.test(await troubleOf(page)), 60000);
  const files = readdirSync(small);
  assert.equal(files.length, 1);
  assert.match(files[0], /^many_\d{4}-.*\.mcap$/);
  await clear(page);
  assert.match((await job(page, 'record', 'more')).reasons[0], /the recordings have the 2 MB that they may have: delete some/);
  await click(page, '[data-tab=recordings]');
  assert.match(await textOf(page, '#recordings-room'), /of 2 MB used/);
  const told = await lab.run('plabctl', 'info', join(small, files[0]));
  assert.equal(told.code, 0, told.text);
  assert.deepEqual(readdirSync(small), files);
});

test('no page had an error', () => assert.deepEqual(lab.troubles, []));
