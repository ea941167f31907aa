// The tree of objects and interactions. Only the rows that are seen exist, so ten thousand cost as much as twenty.
import { byId, duration, h, isPressed, levelText, number, shortType } from './dom.js';

const kHeight = 26; // px of a row

export class Tree {
  constructor(model) {
    this.model = model;
    this.box = byId('tree');
    this.space = h('div.space');
    this.box.append(this.space);
    this.open = new Map([['Objects', true], ['Interactions', true]]);
    this.rows = [];
    this.active = 0;
    byId('filter').addEventListener('input', () => this.fill());
    this.box.addEventListener('scroll', () => this.draw());
    this.box.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(this.box);
    for (const topic of ['structure', 'selected']) model.on(topic, () => this.fill());
    model.on('metrics', () => isPressed() || this.draw());
    this.fill();
  }

  fill() {
    const filter = byId('filter').value.trim().toLowerCase();
    const fits = (thing) => !filter || `${thing.id} ${thing.name} ${thing.type}`.toLowerCase().includes(filter);
    this.rows = [];
    const section = (name, things) => {
      const found = things.filter(fits);
      this.rows.push({ group: name, count: found.length, level: 1 });
      if (this.open.get(name)) this.rows.push(...found.map((thing, i) => ({ thing, level: 2, place: i + 1, of: found.length })));
    };
    // What can be exchanged comes first, couplings before solvers.
    const rank = (i) => ['Constraint', 'Script', 'CDetection', 'Resolution', 'Response', 'Manager', 'Field', 'Solver'].indexOf(i.type.split('/')[0]);
    section('Interactions', [...this.model.interactions.values()].sort((a, b) => (rank(a) + 20) % 20 - (rank(b) + 20) % 20 || a.id.localeCompare(b.id)));
    section('Objects', [...this.model.objects.values()]);
    this.active = Math.min(this.active, this.rows.length - 1);
    const selected = this.rows.findIndex((row) => row.thing?.id === this.model.selected);
    if (selected >= 0) this.active = selected;
    this.space.style.height = `${this.rows.length * kHeight}px`;
    this.draw();
  }

  draw() {
    const first = Math.max(0, Math.floor(this.box.scrollTop / kHeight) - 4);
    const last = Math.min(this.rows.length, Math.ceil((this.box.scrollTop + this.box.clientHeight) / kHeight) + 4);
    const children = [];
    for (let i = first; i < last; ++i) children.push(this.row(this.rows[i], i));
    this.space.replaceChildren(...children);
    this.box.setAttribute('aria-activedescendant', `row${this.active}`);
  }

  row(row, i) {
    const style = `top:${i * kHeight}px`;
    const common = { id: `row${i}`, role: 'treeitem', style, 'aria-level': String(row.level) };
    const active = i === this.active ? '.active' : '';
    if (row.group) {
      const open = this.open.get(row.group);
      return h(`div.row.group${active}`, { ...common, 'aria-expanded': String(open), onclick: () => this.toggle(row.group) }, `${open ? '▾' : '▸'} ${row.group} (${row.count})`);
    }
    const { thing } = row, selected = thing.id === this.model.selected, numbers = this.model.rows.get(thing.id);
    const level = thing.levels?.level !== undefined ? `level ${levelText(thing.levels.level, thing.levels.levels)}` : '';
    const facts = thing.handle === undefined
      ? [shortType(thing.type), duration(numbers?.cost), numbers && numbers.error !== null ? `err ${number(numbers.error, 2)}` : '', level]
      : [thing.motion === 'static' ? 'static' : thing.kind === 'shaft' ? 'shaft' : 'body', '', '', level];
    return h(`div.row${selected ? '.selected' : ''}${active}${thing.quarantined ? '.bad' : ''}`, {
      ...common, 'aria-selected': String(selected), 'aria-setsize': String(row.of), 'aria-posinset': String(row.place),
      title: `${thing.name || thing.id}: ${thing.type}`, onclick: () => this.choose(i),
    }, h('span.name', {}, thing.id), ...facts.map((fact) => h('span.fact', {}, fact)));
  }

  toggle(group) {
    this.open.set(group, !this.open.get(group));
    this.fill();
  }

  choose(i) {
    this.active = i;
    if (this.rows[i]?.thing) this.model.select(this.rows[i].thing.id);
  }

  key(event) {
    const moves = { ArrowDown: 1, ArrowUp: -1, PageDown: 12, PageUp: -12, Home: -1e9, End: 1e9 };
    const row = this.rows[this.active];
    if (moves[event.key]) this.active = Math.min(this.rows.length - 1, Math.max(0, this.active + moves[event.key]));
    else if (event.key === 'Enter' || event.key === ' ') row?.group ? this.toggle(row.group) : this.choose(this.active);
    else if (event.key === 'ArrowLeft' && row?.group && this.open.get(row.group)) this.toggle(row.group);
    else if (event.key === 'ArrowRight' && row?.group && !this.open.get(row.group)) this.toggle(row.group);
    else return;
    event.preventDefault();
    const top = this.active * kHeight;
    if (top < this.box.scrollTop) this.box.scrollTop = top;
    if (top + kHeight > this.box.scrollTop + this.box.clientHeight) this.box.scrollTop = top + kHeight - this.box.clientHeight;
    this.draw();
  }
}
