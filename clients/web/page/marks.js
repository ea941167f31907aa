// Drawn over the shapes: the selection, contacts, impulses and forces as arrows, and joints as lines.
import * as THREE from 'three';
import { ForceArrows } from './force_arrows.js';
import { vector } from './dom.js';

const kMostContacts = 512, kFewContacts = 48, kMostArrows = 48, kMostJoints = 4000;
const kFade = 600; // ms for which an impulse is seen

export class Marks {
  constructor(group, props, model) {
    this.group = group;
    this.props = props;
    this.model = model;
    this.contacts = new Map();
    this.impulses = [];
    this.strongest = 1e-9; // N s, of those seen lately
    this.show = { contacts: true, joints: true, forces: false };
    this.makeSelection();
    this.makeContacts();
    this.makeArrows();
    this.pressing = new ForceArrows(group);
    this.makeJoints();
  }

  makeSelection() {
    this.outline = new THREE.Group();
    this.outlineMaterial = new THREE.MeshBasicMaterial({ color: 0xff9f1a, side: THREE.BackSide });
    this.group.add(this.outline);
  }

  makeContacts() {
    this.dots = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 10, 8), new THREE.MeshBasicMaterial({ color: 0xff3b6b, depthTest: false, transparent: true, opacity: 0.85 }), kMostContacts);
    this.dots.frustumCulled = false;
    this.dots.count = 0;
    this.dots.renderOrder = 2;
    this.group.add(this.dots);
  }

  makeArrows() {
    this.arrows = Array.from({ length: kMostArrows }, () => {
      const arrow = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1, 0xff3b6b);
      arrow.visible = false;
      for (const part of [arrow.line, arrow.cone]) {
        part.material.depthTest = false;
        part.renderOrder = 3;
      }
      this.group.add(arrow);
      return arrow;
    });
  }

  makeJoints() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(6 * kMostJoints), 3).setUsage(THREE.DynamicDrawUsage));
    this.lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0x7b5cff, depthTest: false, transparent: true, opacity: 0.8 }));
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 1;
    this.group.add(this.lines);
    this.joints = [];
  }

  // After a change of the structure.
  rebuild() {
    this.joints = [];
    for (const interaction of this.model.interactions.values()) {
      if (!interaction.type.startsWith('Constraint/') || this.joints.length >= kMostJoints) continue;
      const ids = Object.values(interaction.roles ?? {}).flat().filter((id) => this.model.objects.has(id));
      const [a, b] = ids.length >= 2 ? ids : [null, ids[0]];
      if (!b) continue;
      this.joints.push({ a, b, pointA: vector(interaction.joint?.point_a), pointB: vector(interaction.joint?.point_b) });
    }
    for (const [key, contact] of this.contacts) if (!this.model.objects.has(contact.a) || !this.model.objects.has(contact.b)) this.contacts.delete(key);
    this.select(this.model.selected);
  }

  clear() {
    this.contacts.clear();
    this.impulses.length = 0;
  }

  select(id) {
    this.outline.clear();
    this.parts = id && this.model.objects.has(id) ? this.props.partsOf(id) : [];
    const participants = id && this.model.interactions.get(id)?.roles;
    if (participants) for (const other of Object.values(participants).flat().slice(0, 20)) this.parts.push(...this.props.partsOf(other));
    for (const part of this.parts) {
      const mesh = new THREE.Mesh(part.geometry, this.outlineMaterial);
      mesh.matrixAutoUpdate = false;
      this.outline.add(mesh);
    }
  }

  takeCollisions(entries) {
    const now = performance.now();
    for (const c of entries) {
      const key = `${c.detector}\n${c.a}\n${c.b}`;
      if (c.kind === 'end') this.contacts.delete(key);
      else if (c.kind !== 'impact') this.contacts.set(key, c);
      const size = Math.hypot(...c.impulse);
      if (size > 0) {
        this.strongest = Math.max(0.98 * this.strongest, size);
        this.impulses.push({ at: c.position, impulse: c.impulse, size, until: now + kFade });
      }
    }
    if (this.impulses.length > kMostArrows) this.impulses.splice(0, this.impulses.length - kMostArrows);
  }

  // Something of it changes by itself.
  get isAlive() { return this.impulses.length > 0; }

  // `reach`: m that an arrow of the strongest impulse is long; `dot`: radius of a contact.
  update(now, reach, dot) {
    this.updateSelection();
    this.updateContacts(dot);
    this.updateArrows(now, reach);
    this.pressing.update(this.show.forces ? this.model : null, reach);
    this.updateJoints();
  }

  updateSelection() {
    const grow = new THREE.Matrix4();
    this.parts?.forEach((part, i) => {
      const mesh = this.outline.children[i];
      part.write(mesh.matrix.elements);
      mesh.matrix.multiply(grow.makeScale(1.06, 1.06, 1.06));
    });
  }

  updateContacts(radius) {
    // Many are small, so that one sees between them what touches.
    radius *= Math.min(1, Math.sqrt(kFewContacts / Math.max(1, this.contacts.size)));
    const matrix = new THREE.Matrix4();
    let i = 0;
    if (this.show.contacts)
      for (const contact of this.contacts.values()) {
        if (i >= kMostContacts) break;
        this.dots.setMatrixAt(i++, matrix.makeScale(radius, radius, radius).setPosition(...contact.position));
      }
    this.dots.count = i;
    this.dots.instanceMatrix.needsUpdate = true;
  }

  updateArrows(now, reach) {
    this.impulses = this.impulses.filter((impulse) => impulse.until > now);
    const wanted = this.show.contacts ? this.impulses.map((impulse) => ({ at: impulse.at, vector: impulse.impulse, share: impulse.size / this.strongest, color: 0xff3b6b })) : [];
    wanted.push(...this.forces());
    const direction = new THREE.Vector3();
    this.arrows.forEach((arrow, i) => {
      const one = wanted[i];
      arrow.visible = one !== undefined;
      if (!one) return;
      const long = reach * Math.max(0.15, Math.min(1, one.share));
      arrow.position.set(...one.at);
      arrow.setDirection(direction.set(...one.vector).normalize());
      arrow.setLength(long, 0.25 * long, 0.12 * long);
      arrow.setColor(one.color);
    });
  }

  // What watched interactions say of the force on their body b.
  forces() {
    const out = [];
    for (const [id, outputs] of this.model.outputs) {
      const force = vector(outputs.find((o) => o.name === 'force')?.text);
      const roles = this.model.interactions.get(id)?.roles;
      const body = roles && (roles.b ?? roles.driven ?? roles.body ?? [])[0];
      const at = body && this.props.positionOf(body);
      if (!force || !at || Math.hypot(...force) === 0) continue;
      this.strongestForce = Math.max(0.98 * (this.strongestForce ?? 0), Math.hypot(...force));
      out.push({ at, vector: force, share: Math.hypot(...force) / this.strongestForce, color: 0x18b36b });
    }
    return out;
  }

  updateJoints() {
    const positions = this.lines.geometry.attributes.position.array;
    let n = 0;
    if (this.show.joints)
      for (const joint of this.joints) {
        const b = this.point(joint.b, joint.pointB), a = joint.a ? this.point(joint.a, joint.pointA) : this.props.positionOf(joint.b);
        if (!a || !b) continue;
        positions.set(a, 6 * n);
        positions.set(b, 6 * n + 3);
        ++n;
      }
    this.lines.geometry.setDrawRange(0, 2 * n);
    this.lines.geometry.attributes.position.needsUpdate = true;
  }

  // From the origin of a body to its end of the joint both bodies' lines meet; without such a point, the origin.
  point(id, local) {
    const pose = this.props.poseOf(id);
    if (!pose || !local) return pose?.subarray(0, 3) ?? null;
    const q = new THREE.Quaternion(pose[4], pose[5], pose[6], pose[3]);
    return new THREE.Vector3(...local).applyQuaternion(q).add(new THREE.Vector3(pose[0], pose[1], pose[2])).toArray();
  }
}
