// The page of plab-web: puts its parts together.
import { Details } from './details.js';
import { byId, duration, h, number, seconds } from './dom.js';
import { Jobs } from './jobs.js';
import { Levels } from './levels.js';
import { Model } from './model.js';
import { Plots } from './plots.js';
import { Poses } from './poses.js';
import { Quantities } from './quantities.js';
import { Socket } from './socket.js';
import { Timeline } from './timeline.js';
import { Tree } from './tree.js';
import { View } from './view.js';

const model = new Model(), poses = new Poses();

// ---- Words for the user ----

function say(text, isTrouble = false) {
  const box = byId(isTrouble ? 'trouble' : 'notes');
  const note = h(`p.${isTrouble ? 'bad' : 'good'}`, {}, text, h('button', { 'aria-label': 'Close', onclick: () => note.remove() }, '×'));
  box.prepend(note);
  while (box.children.length > 3) box.lastChild.remove();
  setTimeout(() => note.remove(), isTrouble ? 15000 : 4000);
}

// `text`: what was done, said when it is done; null: the caller shows the reply.
async function ask(text, ...operations) { return tellReply(text, await socket.request(...operations)); }

function tellReply(text, reply) {
  if (text === null) return reply;
  if (reply.outcome === 'done') say(`${text}, at step ${reply.step}.`);
  else say(`${reply.outcome === 'refused' ? 'The server refused this' : reply.outcome === 'late' ? 'This came too late' : 'There was no answer'}: ${(reply.reasons ?? []).join('; ')}`, true);
  return reply;
}

// ---- The socket ----

const socket = new Socket({
  message: (message) => {
    if (message.type === 'found') {
      poses.clear();
      view.placed = null;
      return;
    }
    if (!jobs.take(message)) model.take(message);
  },
  poses: (buffer) => {
    const moment = view.take(buffer);
    if (!moment) return;
    plots.sampleFrame(moment);
    model.tell('poses', moment);
  },
  state: (state) => {
    if (state === 'lost') model.setState('lost', 'The connection to plab-web is lost. Trying to connect again; if plab-web was started anew, open the address that it printed then.');
    else {
      sendWatch();
      jobs.begin();
    }
  },
});

// ---- What this page wants to know more of ----

let plotted = [];
function sendWatch() {
  const components = [...new Set([model.selected, ...plotted].filter(Boolean))].slice(0, 16);
  socket.send({ type: 'watch', components });
}
model.on('selected', sendWatch);
model.on('begin', sendWatch);

// Contacts are read only while they are shown, and no faster than that: the next are asked for when these have come.
let contactsAsked = false;
const wantsContacts = () => view.marks.show.forces || model.objects.get(model.selected)?.kind === 'body';
function followContacts() {
  if (contactsAsked || !wantsContacts() || document.hidden) return;
  contactsAsked = true;
  socket.send({ type: 'contacts' });
}
model.on('contacts', (contacts) => {
  if (!contacts) return;
  contactsAsked = false;
  requestAnimationFrame(followContacts);
});
model.on('selected', followContacts);
model.on('begin', () => {
  contactsAsked = false;
  followContacts();
});
document.addEventListener('visibilitychange', followContacts);

const hand = {
  async grab(id, position) {
    const force = Math.max(1, 60 * (model.objects.get(id)?.mass ?? 1));
    const reply = await socket.ask({ type: 'grab', body: id, position, force });
    if (reply.outcome !== 'done') tellReply('', reply);
  },
  move: (position) => socket.send({ type: 'move', position }),
  release: () => socket.send({ type: 'release' }),
  // 1 m/s along the view.
  push(id, direction, point) {
    const { mass } = model.objects.get(id);
    ask(`Pushed ${id}`, { verb: 'push', target: id, values: { impulse: direction.map((v) => v * mass).join(' '), point: point.join(' ') } });
  },
};

const view = new View(byId('picture'), model, poses, socket, hand);
const quantities = new Quantities(model);
const plots = new Plots(model, quantities, (components) => {
  plotted = components;
  sendWatch();
});
const tree = new Tree(model);
const levels = new Levels(model, {
  select: (id) => model.select(id),
  search(text) {
    byId('filter').value = text;
    byId('filter').dispatchEvent(new Event('input'));
    if (innerWidth < 800) showTab('tree');
  },
});
const jobs = new Jobs(model, socket, {
  say, showTab: (name) => showTab(name),
  looks() {
    poses.clear();
    view.placed = null;
    model.select(null);
  },
});
const timeline = new Timeline(model, {
  seek: (time) => jobs.ask('seek', jobs.shown, time),
  rewind: (time) => ask(`Went back to ${seconds(time)}`, { verb: 'rewind', argument: String(time) }),
  keep: (name) => ask(`Kept as ${name}`, { verb: 'snapshot', target: name }),
  restore: (name) => ask(`Returned to ${name}`, { verb: 'restore', target: name }),
});
const details = new Details(model, {
  ask, preview: (component, type) => socket.ask({ type: 'preview', component, with: type, seconds: 1 }),
  plot: (name) => {
    if (plots.add(name)) showTab('plots');
  },
  look: (id) => view.lookAt(id), follow: () => toggleFollow(), isFollowing: () => view.follow,
  stateOf: (object) => {
    const moment = poses.newest;
    if (object.kind === 'shaft') {
      const place = moment?.layout.shafts.get(object.handle);
      return place === undefined ? [] : [['angle', [moment.shafts[2 * place]], 'rad'], ['speed', [moment.shafts[2 * place + 1]], 'rad/s']];
    }
    const exact = moment?.exact.get(object.handle);
    if (!exact) return [['position', object.position, 'm']];
    return [['position', [...exact.slice(0, 3)], 'm'], ['velocity', [...exact.slice(7, 10)], 'm/s'], ['angular velocity', [...exact.slice(10, 13)], 'rad/s']];
  },
});

// ---- Bar ----

const isPaused = () => model.server?.paused ?? false;
const togglePause = () => (jobs.isPlayback ? jobs.do(isPaused() ? 'resume' : 'pause', jobs.shown) : ask(isPaused() ? 'Goes on' : 'Paused', { verb: isPaused() ? 'resume' : 'pause' }));
const stepOnce = () => ask(null, { verb: 'step', argument: byId('steps').value || '1' }).then((reply) => reply.outcome !== 'done' && tellReply('', reply));
const reset = () => ask('Begins anew', { verb: 'reset' });

function toggleFollow() {
  view.follow = !view.follow;
  byId('follow').setAttribute('aria-pressed', String(view.follow));
  details.fill();
}

function setMode(mode) {
  view.mode = view.mode === mode ? 'look' : mode;
  for (const name of ['grab', 'push']) byId(name).setAttribute('aria-pressed', String(view.mode === name));
  byId('picture').style.cursor = view.mode === 'look' ? '' : 'crosshair';
}

byId('pause').onclick = togglePause;
byId('step').onclick = stepOnce;
byId('reset').onclick = reset;
byId('rate').onchange = (event) => (jobs.isPlayback ? jobs.do('rate', jobs.shown, event.target.value === 'real' ? 1 : Number(event.target.value)) : ask(`The rate is ${event.target.value}`, { verb: 'rate', argument: event.target.value }));
byId('follow').onclick = toggleFollow;
byId('fit').onclick = () => view.fitAll();
byId('grab').onclick = () => setMode('grab');
byId('push').onclick = () => setMode('push');
byId('show-joints').onchange = (event) => {
  view.marks.show.joints = event.target.checked;
  view.isChanged = true;
};
byId('show-forces').onchange = (event) => {
  view.marks.show.forces = event.target.checked;
  view.isChanged = true;
  followContacts();
};
byId('show-contacts').onchange = (event) => {
  view.marks.show.contacts = event.target.checked;
  view.isChanged = true;
};
byId('shadows').onchange = (event) => {
  view.shadows = event.target.value;
  view.tooSlow = false;
  view.isChanged = true;
};
byId('camera').onchange = (event) => {
  const camera = model.scene?.cameras.find((c) => c.name === event.target.value);
  if (camera) view.useCamera(camera);
  else view.fitAll();
};
byId('help').onclick = () => byId('help-text').showModal();

model.on('structure', () => {
  byId('camera').replaceChildren(h('option', { value: '' }, 'everything'), ...(model.scene?.cameras ?? []).map((camera) => h('option', { value: camera.name }, camera.name)));
  const first = model.scene?.cameras.find((c) => c.name === 'front') ?? model.scene?.cameras[0];
  byId('camera').value = first?.name ?? '';
  document.title = `${model.scene?.title || 'pLab'} – pLab`;
  byId('title').textContent = model.scene?.title || model.scene?.file || '';
});

model.on('server', (server) => {
  byId('server').textContent = `${server.name}, run ${server.run}`;
  byId('pause').textContent = server.paused ? '▶ Go on' : '❚❚ Pause';
  if (document.activeElement !== byId('rate')) byId('rate').value = server.rate_asked === 0 ? 'max' : server.rate_asked === 1 ? 'real' : String(server.rate_asked);
  byId('overload').textContent = server.overload ? 'Too slow' : '';
  byId('overload').title = overloadText(server);
});

function overloadText({ overload }) {
  if (!overload) return '';
  return overload === 'slip' ? 'The steps take longer than the time that they simulate: the scene is slower than was asked for.' : `The steps take too long; the server does this about it: ${overload}`;
}
model.on('trouble', (text) => say(text, true));
model.on('state', showState);
function showState() {
  byId('state').className = model.state.kind;
  byId('state').textContent = model.state.text;
  byId('state').hidden = model.state.kind === 'there';
}

setInterval(() => {
  // plabd says that it is there at least once a second.
  if (model.state.kind === 'there' && model.heardAt && performance.now() - model.heardAt > 3000) model.setState('silent', 'The server has said nothing for 3 s. It may be stopped or gone; waiting for it.');
  timeline.follow(view.shownTime);
  byId('clock').textContent = seconds(view.shownTime ?? model.server?.time ?? 0);
  // The bus is read only while a page has asked lately.
  if (contactsAsked && wantsContacts() && !document.hidden) socket.send({ type: 'contacts' });
  const { full } = view.marks.pressing;
  byId('force-scale').textContent = view.marks.show.forces ? (model.contacts ? `↑ ${number(full, 3)} N` : 'with the next step') : '';
  byId('facts').textContent = [
    isPaused() ? 'paused' : `× ${number(model.server?.rate_reached ?? 0, 3)}`, model.metrics && `step ${duration(model.metrics.step_ns)}`,
    model.metrics && `${model.metrics.contacts} contacts`, `${Math.round(view.picturesPerSecond)} pictures/s`,
  ].filter(Boolean).join(' · ');
}, 250);

// ---- Tabs (of a phone, and of the lower panel) ----

function showTab(name) {
  for (const tab of document.querySelectorAll('[data-tab]')) tab.setAttribute('aria-selected', String(tab.dataset.tab === name));
  document.body.dataset.tab = name;
  plots.isStale = true;
  timeline.draw();
  tree.draw();
  levels.fill();
}
for (const tab of document.querySelectorAll('[data-tab]')) tab.addEventListener('click', () => showTab(tab.dataset.tab));
showTab('plots');
model.on('selected', (id) => {
  if (id && innerWidth < 800) showTab('details');
});

// ---- Dark and light ----

function useTheme(theme) {
  document.documentElement.dataset.theme = theme;
  localStorage.setItem('plab-theme', theme);
  byId('theme').value = theme;
  const style = getComputedStyle(document.documentElement);
  view.setBackground(...['--sky', '--grid', '--force', '--impact'].map((name) => style.getPropertyValue(name).trim()));
  plots.isStale = true;
}
byId('theme').onchange = (event) => useTheme(event.target.value);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => useTheme(byId('theme').value));
useTheme(localStorage.getItem('plab-theme') ?? 'auto');

// ---- Keys ----

document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|TEXTAREA|SELECT|DIALOG)$/.test(event.target.tagName)) return;
  if (event.target.tagName === 'BUTTON' && event.key === ' ') return;
  const keys = {
    ' ': togglePause, '.': stepOnce, f: toggleFollow, a: () => view.fitAll(), g: () => setMode('grab'), p: () => setMode('push'),
    '/': () => byId('filter').focus(), '?': () => byId('help-text').showModal(), Escape: () => model.select(null),
  };
  const camera = model.scene?.cameras[Number(event.key) - 1];
  if (keys[event.key]) keys[event.key]();
  else if (camera) view.useCamera(camera);
  else return;
  event.preventDefault();
});

// What can be measured of the page, for tests.
globalThis.plab = { model, poses, view, socket, plots, jobs };
showState();
