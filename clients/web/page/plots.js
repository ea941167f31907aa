// Diagrams over simulated time: the ledger of energy, the time of a step, and any quantity that is added.
import uPlot from 'uplot';
import { byId, h, number } from './dom.js';

const kColors = ['#2f7ed8', '#e4572e', '#2a9d5c', '#9355c7', '#d49a00', '#0fa3b1'];
// Equal lines are told apart by their width and dashes.
const kDashes = [[], [3, 5], [8, 4], [2, 3], [12, 4, 2, 4]];
const kMost = 3000;   // points of a line
const kHeight = 150;  // px
const kMostPlots = 8;

export class Plots {
  // watch(components): the page needs numbers of these
  constructor(model, quantities, watch) {
    Object.assign(this, { model, quantities, watch });
    this.box = byId('plots');
    this.plots = new Map();
    this.list = byId('quantities');
    byId('add-plot').addEventListener('submit', (event) => {
      event.preventDefault();
      const input = byId('quantity');
      if (this.add(input.value.trim())) input.value = '';
    });
    this.addLedger();
    model.on('run', () => this.clear());
    model.on('begin', () => this.bind());
    model.on('events', () => { this.isStale = true; });
    model.on('structure', () => this.list.replaceChildren(...quantities.names().slice(0, 3000).map((name) => h('option', { value: name }))));
    model.on('metrics', () => this.sampleMetrics());
    setInterval(() => this.draw(), 200);
    new ResizeObserver(() => { this.isStale = true; }).observe(this.box);
  }

  addLedger() {
    const labels = ['kinetic', 'stored', 'work', 'of requests', 'unexplained'];
    this.addPlot('Energy', { labels, unit: 'J', rows: () => this.model.energy.map((row) => row.slice(0, 6)), about: 'Kinetic and stored energy; work of all interactions since the run began, the part of it that requests did, and what is left unexplained' });
    this.addPlot('Time of a step', { labels: ['step'], unit: 'ms', rows: () => this.model.energy.map((row) => [row[0], row[6] * 1e-6]), about: 'Processor time of a step, median of the last steps' });
  }

  // False: there is no such quantity, or no room.
  add(name) {
    if (this.plots.has(name)) {
      this.plots.get(name).box.scrollIntoView({ block: 'nearest' });
      return true;
    }
    const quantity = this.quantities.find(name);
    if (!quantity) return this.model.tell('trouble', `There is no quantity '${name}'. Names look like red.position.x, gears.cost or energy.kinetic.`), false;
    if (this.plots.size >= kMostPlots) return this.model.tell('trouble', `There are ${kMostPlots} plots; close one first.`), false;
    const data = [];
    this.addPlot(name, { labels: [name], unit: quantity.unit, rows: () => data, data, quantity, about: `${name}${quantity.unit ? `, in ${quantity.unit}` : ''}, over simulated time`, closable: true });
    this.tellWatch();
    return true;
  }

  addPlot(title, plot) {
    const close = plot.closable && h('button.plot', { 'aria-label': `Close the plot of ${title}`, onclick: () => this.remove(title) }, '×');
    plot.value = h('output', { 'aria-label': `${title} now` });
    plot.canvas = h('div', { role: 'img', 'aria-label': plot.about });
    plot.box = h('figure', {}, h('figcaption', { title: plot.about }, h('b', {}, title), ` ${plot.unit} `, plot.value, close), plot.canvas);
    this.plots.set(title, plot);
    this.box.append(plot.box);
    this.isStale = true;
  }

  remove(title) {
    const plot = this.plots.get(title);
    plot.uplot?.destroy();
    plot.box.remove();
    this.plots.delete(title);
    this.tellWatch();
  }

  // The scene is another one: what it has not is closed.
  bind() {
    for (const [name, plot] of this.plots) {
      if (!plot.quantity) continue;
      plot.quantity = this.quantities.find(name);
      if (plot.quantity) plot.data.length = 0;
      else this.remove(name);
    }
    this.isStale = true;
  }

  tellWatch() { this.watch([...this.plots.values()].map((plot) => plot.quantity?.component).filter(Boolean)); }

  clear() {
    for (const plot of this.plots.values()) if (plot.data) plot.data.length = 0;
    this.isStale = true;
  }

  put(plot, time, value) {
    if (value === null) return;
    const { data } = plot;
    while (data.length && data.at(-1)[0] >= time) data.pop(); // after a rewind
    data.push([time, value]);
    if (data.length > kMost) data.splice(0, data.length - kMost);
    this.isStale = true;
  }

  sampleFrame(moment) { for (const plot of this.plots.values()) if (plot.quantity?.ofFrame) this.put(plot, moment.time, plot.quantity.ofFrame(moment)); }

  sampleMetrics() {
    for (const plot of this.plots.values()) if (plot.quantity?.ofMetrics) this.put(plot, this.model.metrics.time, plot.quantity.ofMetrics());
    this.isStale = true;
  }

  draw() {
    if (!this.isStale || this.box.clientWidth < 50) return;
    this.isStale = false;
    for (const plot of this.plots.values()) this.drawPlot(plot);
  }

  drawPlot(plot) {
    const rows = plot.rows(), width = plot.box.clientWidth - 4;
    const columns = Array.from({ length: plot.labels.length + 1 }, (_, i) => rows.map((row) => row[i]));
    plot.value.textContent = plot.labels.length === 1 && rows.length ? number(rows.at(-1)[1], 5) : '';
    if (!plot.uplot) plot.uplot = new uPlot(this.options(plot, width), columns, plot.canvas);
    else plot.uplot.setData(columns);
    if (plot.uplot.width !== width && width > 50) plot.uplot.setSize({ width, height: kHeight });
  }

  options(plot, width) {
    const ink = () => getComputedStyle(document.body).getPropertyValue('--ink').trim();
    const lines = () => getComputedStyle(document.body).getPropertyValue('--line').trim();
    const axis = { stroke: ink, grid: { stroke: lines, width: 1 }, ticks: { stroke: lines }, font: '11px sans-serif' };
    return {
      width, height: kHeight, legend: { show: plot.labels.length > 1, live: false }, cursor: { drag: { x: false, y: false } },
      scales: { x: { time: false } },
      axes: [{ ...axis, size: 28 }, { ...axis, size: 58, values: (_, ticks) => ticks.map((t) => number(t, 4)) }],
      series: [{ label: 's', value: (_, v) => (v === null ? '' : v.toFixed(2)) }, ...plot.labels.map((label, i) => ({ label, stroke: kColors[i % kColors.length], width: i === 0 && plot.labels.length > 1 ? 3.5 : 1.5, dash: kDashes[i % kDashes.length], points: { show: false }, value: (_, v) => number(v) }))],
    };
  }
}
