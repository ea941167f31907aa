// What plab-web does beside the server: recordings, playbacks, branches, and which server this page looks at.
import { byId, h, isPressed, present, size } from './dom.js';

const kReally = 4000; // ms for which a second press deletes

export class Jobs {
  // page: { say(text, isTrouble), showTab(name), looks() }, the last when another server is looked at
  constructor(model, socket, page) {
    this.model = model;
    this.socket = socket;
    this.page = page;
    this.jobs = { recording: null, servers: [] };
    this.recordings = { is_on: false, list: [] };
    this.shown = ''; // name of the server that is looked at; '': that of plab-web
    this.home = '';
    this.wanted = null; // the server that was asked for and is not shown yet
    byId('record').addEventListener('click', () => (this.jobs.recording ? this.stop() : this.record('')));
    byId('record-form').addEventListener('submit', (event) => {
      event.preventDefault();
      if (this.jobs.recording) this.stop();
      else this.record(byId('record-name').value.trim());
    });
    byId('branch').addEventListener('click', () => this.branch());
    byId('shown').addEventListener('change', (event) => this.look(event.target.value));
    model.on('begin', () => this.ask('list'));
    model.on('state', () => model.state.kind === 'gone' && this.ask('list'));
    model.on('server', (server) => {
      if (this.shown === '' && server.name !== this.home) {
        this.home = server.name;
        this.fill();
      }
    });
    this.fill();
  }

  get isPlayback() { return this.kindOf(this.shown) === 'playback'; }

  kindOf(server) { return this.jobs.servers.find((one) => one.name === server)?.kind ?? (server ? this.kind : ''); }

  ask(verb, name = '', value = 0) { return this.socket.ask({ type: 'job', verb, name, value }); }

  // As ask(), and says why if it was not done.
  async do(verb, name, value) {
    const reply = await this.ask(verb, name, value);
    if (reply.outcome !== 'done') this.page.say(`This was not done: ${(reply.reasons ?? []).join('; ')}.`, true);
    return reply.outcome === 'done' ? reply : null;
  }

  take(message) {
    const by = {
      jobs: () => this.takeJobs(message),
      recordings: () => {
        this.recordings = message;
        this.fill();
      },
      notice: () => this.page.say(message.text, true),
      position: () => {
        this.model.playback = message;
        this.model.tell('playback', message);
      },
      looking: () => this.takeLooking(message),
    }[message.type];
    by?.();
    return by !== undefined;
  }

  takeJobs(message) {
    this.jobs = message;
    // What is looked at has ended: back.
    if (this.shown && !message.servers.some((one) => one.name === this.shown)) this.look('');
    this.kind = this.kindOf(this.shown);
    this.fill();
  }

  takeLooking({ id, server }) {
    this.socket.settle({ id, outcome: 'done' });
    this.socket.giveUp('Another server is shown now; whether this was done is unknown.');
    this.shown = server;
    this.kind = this.kindOf(server);
    this.model.playback = null;
    this.model.server = null;
    this.model.setState('wait', server ? `Opening ${server}.` : 'Opening the server.');
    history.replaceState(null, '', server ? `#${server}` : location.pathname);
    this.page.looks();
    this.fill();
  }

  // The socket is open: plab-web shows its own server until it is asked for another one.
  async begin() {
    const wanted = this.shown || decodeURIComponent(location.hash.slice(1));
    this.shown = '';
    this.model.playback = null;
    if (wanted) this.look(wanted);
  }

  async look(server) {
    if (this.wanted === server) return;
    this.wanted = server;
    const reply = await this.ask('look', server);
    this.wanted = null;
    if (reply.outcome === 'refused') {
      history.replaceState(null, '', location.pathname);
      this.page.say(`${server} is not there any more.`, true);
    }
    this.fill();
  }

  async record(name) {
    if (!this.recordings.is_on) return this.page.showTab('recordings');
    const reply = await this.do('record', name);
    if (!reply) return;
    byId('record-name').value = '';
    this.page.say(`Recording as ${reply.name}.`);
  }

  async stop() {
    const reply = await this.do('stop');
    if (reply) this.page.say(`${reply.name} is recorded; the tab Recordings has it.`);
    if (reply) this.page.showTab('recordings');
  }

  async play(name) {
    const reply = await this.do('play', name);
    if (reply) await this.look(reply.server);
  }

  async branch() {
    const reply = await this.do('branch', '', this.model.server?.paused ? 1 : 0);
    if (!reply) return;
    await this.look(reply.server);
    this.page.say(`${reply.server} goes on from here by itself; what happens in it does not change ${this.home}.`);
  }

  async leave(isEnd) {
    const left = this.shown;
    await this.look('');
    if (isEnd) await this.do('end', left);
  }

  // ---- What is shown ----

  fill() {
    this.fillButtons();
    this.fillChoice();
    this.fillBanner();
    if (!isPressed()) this.fillList();
  }

  fillButtons() {
    const { recording } = this.jobs, elsewhere = this.isPlayback;
    const text = recording ? `■ Stop recording ${recording.seconds} s, ${size(recording.bytes)}` : '● Record';
    byId('record').textContent = text;
    byId('record').classList.toggle('bad', recording !== null);
    byId('record').title = this.recordings.is_on ? 'What the server sends, to a file that can be played here' : 'Recording is off: the tab Recordings says how to turn it on';
    byId('record').disabled = elsewhere && !recording;
    byId('branch').disabled = elsewhere;
    byId('record-now').textContent = recording ? 'Stop' : 'Record';
    byId('record-now').disabled = elsewhere && !recording;
    byId('record-name').disabled = recording !== null;
    document.body.dataset.shown = this.kindOf(this.shown);
    for (const id of ['step', 'steps', 'reset', 'keep', 'grab', 'push']) byId(id).disabled = elsewhere;
    byId('rate').querySelector('[value=max]').disabled = elsewhere;
  }

  fillChoice() {
    const choice = byId('shown'), others = this.jobs.servers.filter((one) => one.is_there);
    const key = JSON.stringify([this.home, others, this.shown]);
    if (key === this.choiceKey) return;
    this.choiceKey = key;
    choice.closest('label').hidden = others.length === 0;
    byId('server').hidden = others.length > 0; // the choice says it
    choice.replaceChildren(h('option', { value: '' }, this.home || 'the server'), ...others.map((one) => h('option', { value: one.name }, one.kind === 'playback' ? `${one.of} (recording)` : `${one.name} (branch of ${one.of})`)));
    choice.value = this.shown;
  }

  fillBanner() {
    const one = this.jobs.servers.find((server) => server.name === this.shown);
    if (this.bannerKey === (one ? `${one.name} ${this.home}` : '')) return;
    this.bannerKey = one ? `${one.name} ${this.home}` : '';
    byId('elsewhere').hidden = !one;
    if (!one) return byId('elsewhere').replaceChildren();
    const home = this.home || 'the server', isBranch = one.kind === 'branch';
    byId('elsewhere').replaceChildren(...present([
      h('span', {}, isBranch ? `Branch ${one.name} of ${one.of}: nothing that happens here changes ${one.of}.` : `Recording ${one.of}: drag the line of time; nothing can be changed.`),
      h('button', { id: 'back', onclick: () => this.leave(!isBranch) }, `◀ Back to ${home}`),
      isBranch && h('button', { id: 'end-branch', onclick: () => this.leave(true) }, 'End this branch'),
    ]));
  }

  fillList() {
    const { is_on: isOn, folder, bytes, limit, list } = this.recordings, { recording } = this.jobs;
    byId('record-form').hidden = !isOn;
    const key = JSON.stringify([this.recordings, recording?.name, this.doomed]);
    if (key === this.listKey) return;
    this.listKey = key;
    const room = byId('recordings-room');
    if (!isOn) room.replaceChildren('Recording is off. Start plab-web with ', h('code', {}, '--recordings DIR'), ', and this page may record to that folder and play what is in it.');
    else room.replaceChildren(h('meter', { min: '0', max: String(limit), value: String(bytes), 'aria-label': 'Room of the recordings' }), ` ${size(bytes)} of ${size(limit)} used; a recording ends when nothing is left. Folder: ${folder}`);
    const rows = (list ?? []).map((one) => this.row(one, one.name === recording?.name));
    byId('recordings-list').replaceChildren(...rows);
    byId('recordings-table').hidden = rows.length === 0;
    byId('recordings-none').hidden = !isOn || rows.length > 0;
  }

  row(one, isBeingMade) {
    const { name } = one, really = this.doomed === name;
    const length = isBeingMade ? 'being recorded' : one.seconds !== null ? `${one.seconds.toFixed(1)} s` : one.is_closed ? '…' : 'not closed';
    return h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, new Date(one.date).toLocaleString()), h('td', {}, length), h('td', {}, size(one.bytes)),
      h('td', {}, h('button', { 'data-play': name, 'aria-label': `Play ${name}`, disabled: isBeingMade, onclick: () => this.play(name) }, '▶ Play'),
        ' ', h('button', { 'data-delete': name, 'aria-label': `${really ? 'Really delete' : 'Delete'} ${name}`, disabled: isBeingMade, onclick: () => this.remove(name) }, really ? 'Really delete' : 'Delete')));
  }

  async remove(name) {
    const really = this.doomed === name;
    this.doomed = really ? null : name;
    clearTimeout(this.mercy);
    if (really) await this.do('delete', name);
    else {
      this.mercy = setTimeout(() => {
        this.doomed = null;
        this.fillList();
      }, kReally);
    }
    await this.ask('list');
    this.fillList();
    document.querySelector(`[data-delete="${CSS.escape(name)}"]`)?.focus();
  }
}
