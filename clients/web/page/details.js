// What is known of the selected component: its numbers, its parameters, and the algorithms it can be exchanged for.
import { byId, duration, h, isPressed, levelText, number, present, shortText, shortType } from './dom.js';
import { previewCard, swapCard } from './card.js';

const kMostPairs = 12;

// Of a body: the other body -> { points, normal: N, friction: N, depth: m, isImpact, asleep }.
function pairsOf(points, id) {
  const out = new Map();
  for (const point of points) {
    const other = point.a === id ? point.b : point.b === id ? point.a : null;
    if (other === null) continue;
    const pair = out.get(other) ?? { points: 0, normal: 0, friction: [0, 0, 0], depth: -Infinity, isImpact: false, asleep: point.asleep };
    ++pair.points;
    pair.normal += point.normal;
    pair.friction = pair.friction.map((value, i) => value + point.friction[i]);
    pair.depth = Math.max(pair.depth, point.depth);
    pair.isImpact ||= point.isImpact;
    out.set(other, pair);
  }
  return out;
}

// The level before, and what is known of both: cost of a step, and error.
function lastChange(levels) {
  const cost = (text) => (text ? duration(1e9 * Number(text)) : 'unknown'), error = (text) => (text ? number(Number(text), 3) : 'unknown');
  return `${levels.level_before}; cost ${cost(levels.level_cost_before)} → ${cost(levels.level_cost_after)}, error ${error(levels.level_error_before)} → ${error(levels.level_error_after)}`;
}

export class Details {
  // actions: { ask(text, ...operations) -> reply, plot(name), look(id), follow() }
  constructor(model, actions) {
    this.model = model;
    this.actions = actions;
    this.box = byId('details');
    this.card = null;
    model.on('selected', () => {
      this.card = null;
      this.fill();
    });
    model.on('structure', () => this.fill());
    model.on('detail', (id) => id === model.selected && this.fillParameters());
    model.on('metrics', () => isPressed() || this.updateNumbers());
    model.on('poses', () => isPressed() || this.updateMotion());
    model.on('contacts', () => isPressed() || this.updateContacts());
    this.fill();
  }

  get thing() { return this.model.objects.get(this.model.selected) ?? this.model.interactions.get(this.model.selected); }

  fill() {
    const thing = this.thing;
    if (!thing) {
      this.box.replaceChildren(h('p.hint', {}, 'Nothing is selected. Click a thing in the picture or in the tree.'));
      return;
    }
    const isObject = thing.handle !== undefined, type = this.model.types.get(thing.type);
    this.numbers = h('dl.numbers');
    this.parameters = h('div');
    this.contacts = isObject && thing.kind !== 'shaft' ? h('section', { 'aria-label': 'Contacts' }) : null;
    this.box.replaceChildren(...present([
      h('h2', {}, thing.name || thing.id),
      h('p.sub', {}, `${thing.id} · ${thing.type}`),
      type?.doc && h('p.doc', {}, sentence(type.doc)),
      thing.quarantined && h('p.bad', { role: 'alert' }, 'It is quarantined: it failed in a step and no longer takes part.'),
      isObject ? this.objectActions(thing) : this.roles(thing),
      this.numbers,
      this.contacts,
      this.card,
      isObject ? null : this.ladder(thing),
      h('h3', {}, 'Parameters'),
      this.parameters,
    ]));
    this.updateNumbers();
    this.updateMotion();
    this.updateContacts();
    this.fillParameters();
  }

  objectActions(object) {
    const canMove = object.motion === 'dynamic' && object.kind !== 'shaft';
    return h('div.buttons', {},
      h('button', { onclick: () => this.actions.look(object.id) }, 'Look at it'),
      h('button', { onclick: () => this.actions.follow(), 'aria-pressed': String(this.actions.isFollowing()) }, 'Follow'),
      canMove && h('button', { onclick: () => this.push(object) }, 'Push up'),
    );
  }

  // An impulse that gives it 1 m/s.
  push(object) {
    this.actions.ask(`Pushed ${object.id} upwards by 1 m/s`, { verb: 'push', target: object.id, values: { impulse: `0 0 ${object.mass}` } });
  }

  roles(interaction) {
    const roles = Object.entries(interaction.roles ?? {}).filter(([, members]) => members.length > 0);
    return h('dl.roles', {}, ...roles.flatMap(([role, members]) => [h('dt', {}, role),
      h('dd', {}, ...members.slice(0, 12).map((id) => h('button.link', { onclick: () => this.model.select(id) }, id)), members.length > 12 ? `and ${members.length - 12} more` : '')]));
  }

  row(name, value, quantity) {
    return [h('dt', {}, name), h('dd', {}, h('span', {}, value), quantity && h('button.plot', { title: `Plot ${quantity}`, 'aria-label': `Plot ${quantity}`, onclick: () => this.actions.plot(quantity) }, '∿'))];
  }

  updateNumbers() {
    const thing = this.thing;
    if (!thing || thing.handle !== undefined || !this.numbers) return;
    const row = this.model.rows.get(thing.id), outputs = this.model.outputs.get(thing.id) ?? [];
    const account = (name) => outputs.find((o) => o.kind === 'account' && o.name === name);
    const error = account('error'), none = account('no_error');
    const rows = [
      ...this.row('works as', row?.resolved || shortType(thing.type)),
      ...this.row('cost of a step', duration(row?.cost), `${thing.id}.cost`),
      ...this.row('error', error ? `${number(row?.error)} ${error.unit}` : none ? `not known: ${none.text}` : number(row?.error), `${thing.id}.error`),
      ...this.row('work done', `${number(row?.work)} J`, `${thing.id}.work`),
    ];
    const { levels } = thing;
    if (levels?.level !== undefined) {
      rows.push(...this.row('level of detail', `${levelText(levels.level, levels.levels)}, chosen by ${levels.governor ?? 'a governor'}`));
      if (levels.level_reason) rows.push(...this.row('because', `${levels.level_reason}, since ${number(Number(levels.level_since))} s`));
      if (levels.level_before) rows.push(...this.row('before', lastChange(levels)));
    }
    for (const output of outputs) if (output.kind !== 'account') rows.push(...this.row(output.name, `${shortText(output.text)} ${output.unit}`, `${thing.id}.${output.name}`));
    this.numbers.replaceChildren(...rows);
  }

  // Of an object, with each frame that came.
  updateMotion() {
    const thing = this.thing;
    if (!thing || thing.handle === undefined || !this.numbers) return;
    const now = performance.now();
    if (this.movedAt && now - this.movedAt < 150 && this.movedId === thing.id) return;
    this.movedAt = now;
    this.movedId = thing.id;
    const state = this.actions.stateOf(thing);
    const rows = [...this.row(thing.kind === 'shaft' ? 'inertia' : 'mass', thing.kind === 'shaft' ? `${number(thing.inertia)} kg m²` : `${number(thing.mass)} kg`)];
    for (const [name, values, unit] of state) {
      const parts = values.length === 3 ? ['x', 'y', 'z'] : [''];
      rows.push(h('dt', {}, name), h('dd', {}, ...parts.map((part, i) => {
        const quantity = `${thing.id}.${name.replaceAll(' ', '_')}${part && `.${part}`}`;
        return h('button.value', { title: `Plot ${quantity}`, onclick: () => this.actions.plot(quantity) }, number(values[i]));
      }), ` ${unit}`));
    }
    this.numbers.replaceChildren(...rows);
  }

  // One line for each body that it touches.
  updateContacts() {
    const thing = this.thing, { contacts } = this.model, now = performance.now();
    if (!thing || !this.contacts) return;
    if (contacts && this.contactsAt && now - this.contactsAt < 150 && this.contactsId === thing.id) return;
    this.contactsAt = now;
    this.contactsId = thing.id;
    if (!contacts) return this.contacts.replaceChildren(h('h3', {}, 'Contacts'), h('p.hint', {}, 'Known with the next step.'));
    const pairs = pairsOf(contacts.points, thing.id);
    if (pairs.size === 0) return this.contacts.replaceChildren(h('h3', {}, 'Contacts'), h('p.hint', {}, 'It touches nothing.'));
    const largest = [...pairs].sort(([, x], [, y]) => y.normal - x.normal);
    const row = ([id, pair]) => h('tr', {}, h('th', { scope: 'row' }, h('button.link', { onclick: () => this.model.select(id) }, id)),
      h('td', {}, pair.isImpact ? 'impact' : pair.asleep ? 'asleep' : ''), h('td', {}, String(pair.points)), h('td', {}, number(pair.normal)), h('td', {}, number(Math.hypot(...pair.friction))), h('td', {}, number(1000 * pair.depth, 3)));
    this.contacts.replaceChildren(h('h3', {}, 'Contacts'), h('table.contacts', {},
      h('thead', {}, h('tr', {}, ...['with', '', 'points', 'normal N', 'friction N', 'depth mm'].map((title) => h('th', { scope: 'col' }, title)))),
      h('tbody', {}, ...largest.slice(0, kMostPairs).map(row))), largest.length > kMostPairs ? h('p.hint', {}, `and ${largest.length - kMostPairs} more`) : '');
  }

  // ---- Algorithms ----

  ladder(interaction) {
    const types = [...this.model.types.values()].filter((type) => type.family === interaction.family);
    if (types.length < 2) return null;
    const rows = types.map((type) => {
      const isNow = type.name === interaction.type;
      return h(`div.algorithm${isNow ? '.now' : ''}`, {},
        h('button', { disabled: isNow, 'data-type': type.name, onclick: () => this.swap(interaction, type.name), 'aria-label': isNow ? `${type.name}, in use` : `Exchange for ${type.name}` }, isNow ? `${shortType(type.name)} ✓` : shortType(type.name)),
        h('span', {}, sentence(type.doc)),
        !isNow && h('button.preview', { 'data-preview': type.name, 'aria-label': `Preview ${type.name}`, title: 'Simulate the next second with it and without it, without touching the scene', onclick: () => this.preview(interaction, type.name) }, 'What if?'),
        h('small', {}, [type.cost && `Cost: ${type.cost}.`, type.accuracy && `Accuracy: ${type.accuracy}.`, type.limits && `Limits: ${type.limits}.`].filter(Boolean).join(' ')));
    });
    return h('section', { 'aria-label': 'Algorithms' }, h('h3', {}, 'Exchange it for'), ...rows);
  }

  async swap(interaction, type) {
    for (const button of this.box.querySelectorAll('.algorithm button')) button.disabled = true;
    const reply = await this.actions.ask(null, { verb: 'swap', target: interaction.id, argument: type });
    this.card = swapCard(reply, interaction.id, type);
    this.fill();
    this.card.scrollIntoView({ block: 'nearest' });
    this.card.focus();
  }

  async preview(interaction, type) {
    for (const button of this.box.querySelectorAll('.algorithm button')) button.disabled = true;
    const reply = await this.actions.preview(interaction.id, type);
    if (this.model.selected !== interaction.id) return;
    this.card = previewCard(reply, type);
    this.fill();
    this.card.scrollIntoView({ block: 'nearest' });
    this.card.focus();
  }

  // ---- Parameters ----

  fillParameters() {
    const parameters = this.model.details.get(this.model.selected);
    if (!this.parameters) return;
    if (!parameters) return this.parameters.replaceChildren(h('p.hint', {}, 'Waiting for them.'));
    // Not under the fingers of somebody who types.
    if (this.parameters.contains(document.activeElement) && document.activeElement.tagName === 'INPUT') return;
    const fields = new Map((this.model.types.get(this.thing?.type)?.fields ?? []).map((field) => [field.name, field]));
    const editable = parameters.filter((p) => p.kind === 'param' || p.kind === 'state');
    this.parameters.replaceChildren(editable.length === 0 ? h('p.hint', {}, 'It has none.') : '', ...editable.map((p) => this.parameter(p, fields.get(p.name))));
  }

  parameter(p, field) {
    const id = `parameter-${p.name}`;
    const about = [field?.doc && sentence(field.doc), field?.rule && `Rule: ${field.rule}.`].filter(Boolean).join(' ');
    const isLong = p.text.includes('\n') || p.text.length > 60;
    const input = isLong ? h('textarea', { id, rows: 4, title: about }) : h('input', { id, title: about, spellcheck: 'false' });
    input.value = p.text;
    const set = async () => {
      if (input.value === p.text) return;
      const target = this.model.selected;
      const reply = await this.actions.ask(`Set ${target}.${p.name} to ${input.value}`, { verb: 'set', target, values: { [p.name]: input.value } });
      if (reply.outcome !== 'done') input.value = p.text;
    };
    input.addEventListener('keydown', (event) => {
      if (event.key === 'Enter' && !isLong) set();
      if (event.key === 'Escape') input.value = p.text;
      event.stopPropagation();
    });
    return h('div.parameter', { title: about }, h('label', { for: id }, p.name, h('small', {}, p.kind === 'state' ? ' state' : '')), input,
      h('span.unit', {}, p.unit), h('button', { onclick: set, 'aria-label': `Set ${p.name}` }, 'Set'));
  }
}

export const sentence = (text) => (text ? text[0].toUpperCase() + text.slice(1) + (/[.!?]$/.test(text) ? '' : '.') : '');
