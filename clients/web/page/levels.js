// Levels of detail: what each governor has chosen, how many run at which level, what that costs and how large the error is.
import { byId, duration, h, isPressed, levelText, number, shortType } from './dom.js';

export class Levels {
  // actions: { select(id), search(text) }
  constructor(model, actions) {
    this.model = model;
    this.actions = actions;
    this.box = byId('levels');
    this.tab = document.querySelector('[data-tab=levels]');
    model.on('structure', () => this.fill());
    model.on('metrics', () => isPressed() || this.fill());
    this.fill();
  }

  fill() {
    const groups = this.groups();
    this.tab.hidden = groups.length === 0;
    if (document.body.dataset.tab !== 'levels') return;
    if (groups.length === 0) return this.box.replaceChildren(h('p.hint', {}, 'No governor chooses levels in this scene.'));
    const head = ['governor', 'level', 'algorithm', 'how many', 'cost of a step', 'largest error'];
    this.box.replaceChildren(h('table', {}, h('thead', {}, h('tr', {}, ...head.map((name) => h('th', { scope: 'col' }, name)), h('td'))),
      h('tbody', {}, ...groups.map((group) => this.row(group)))));
  }

  // One for each governor and level, the cheapest level first.
  groups() {
    const groups = new Map();
    for (const thing of this.model.interactions.values()) {
      const { levels } = thing;
      if (levels?.level === undefined) continue;
      const key = `${levels.governor} ${levels.level} ${thing.type}`;
      if (!groups.has(key)) groups.set(key, { governor: levels.governor ?? '', level: Number(levels.level), of: levels.levels, type: thing.type, text: levels.level_algorithm, count: 0, cost: 0, worst: null });
      const group = groups.get(key), row = this.model.rows.get(thing.id);
      ++group.count;
      group.cost += row?.cost ?? 0;
      const error = row?.error;
      if (error !== null && error !== undefined && (group.worst === null || error > group.worst.error)) group.worst = { error, id: thing.id };
    }
    return [...groups.values()].sort((a, b) => a.governor.localeCompare(b.governor) || a.level - b.level);
  }

  row(group) {
    const link = (text, id) => h('button.link', { onclick: () => this.actions.select(id) }, text);
    return h('tr', {}, h('th', { scope: 'row' }, group.governor ? link(group.governor, group.governor) : '–'), h('td', {}, levelText(group.level, group.of)),
      h('td', { title: group.type }, group.text || shortType(group.type)), h('td', {}, String(group.count)), h('td', {}, duration(group.cost)),
      h('td', {}, group.worst ? h('span', {}, `${number(group.worst.error, 3)}, `, link(group.worst.id, group.worst.id)) : 'not known'),
      h('td', {}, h('button', { 'aria-label': `Show ${group.type} in the tree`, onclick: () => this.actions.search(group.type) }, 'Show them')));
  }
}
