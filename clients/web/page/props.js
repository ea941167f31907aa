// The scene's shapes, exact and instanced: all spheres are one draw call, all boxes another, and each mesh one.
import * as THREE from 'three';
import { Dots } from './dots.js';
import { mixAngle, mixBody } from './poses.js';

const kStaticColor = [0.62, 0.63, 0.66], kMarkColor = [0.95, 0.75, 0.2];
const kPalette = [[0.87, 0.33, 0.28], [0.24, 0.52, 0.78], [0.93, 0.69, 0.22], [0.36, 0.68, 0.42], [0.58, 0.42, 0.74],
  [0.91, 0.51, 0.24], [0.27, 0.68, 0.71], [0.84, 0.44, 0.62], [0.61, 0.66, 0.25], [0.47, 0.56, 0.69]];

// As plab-view chooses: FNV-1a of the id.
export function colorOfId(id) {
  let hash = 2166136261;
  for (const byte of new TextEncoder().encode(id)) hash = Math.imul(hash ^ byte, 16777619) >>> 0;
  return kPalette[((hash ^ (hash >>> 16)) >>> 0) % kPalette.length];
}

function colorOf(object) {
  return object.color ?? (object.kind !== 'shaft' && object.motion === 'static' ? kStaticColor : colorOfId(object.id));
}

// A shaft without shapes is a solid disk of its inertia, within visible bounds, with a mark that shows how it turns.
function axleParts(object) {
  const r = object.inertia > 0 ? Math.pow((4 * object.inertia) / (1000 * Math.PI), 0.2) : 0.05;
  const radius = Math.min(0.5, Math.max(0.05, r)), half = Math.min(0.1, Math.max(0.02, radius / 4));
  const none = [1, 0, 0, 0];
  return [
    { form: 'cylinder', position: [0, 0, 0], rotation: none, scale: [radius, radius, half] },
    { form: 'box', position: [0.82 * radius, 0, 0], rotation: none, scale: [0.22 * radius, 0.08 * radius, 1.12 * half], color: kMarkColor },
  ];
}

function partsOfShape(shape) {
  const base = { position: shape.position, rotation: shape.orientation };
  const [x, y, z] = shape.size;
  switch (shape.form) {
    case 'sphere': return [{ ...base, form: 'sphere', scale: [x, x, x] }];
    case 'box': return [{ ...base, form: 'box', scale: [x, y, z] }];
    case 'cylinder': return [{ ...base, form: 'cylinder', scale: [x, x, z] }];
    case 'plane': return [{ ...base, form: 'plane', scale: [1, 1, 1] }];
    case 'mesh':
    case 'compound': return [{ ...base, form: `mesh:${shape.id}`, scale: [1, 1, 1] }];
    // Exact at every length: two balls and a cylinder.
    case 'capsule': return [{ ...base, form: 'cylinder', scale: [x, x, z] },
      ...[-z, z].map((end) => ({ position: along(shape.position, shape.orientation, end), rotation: shape.orientation, form: 'sphere', scale: [x, x, x] }))];
    default: return [];
  }
}

// p + q (0, 0, z) q*
function along(p, [w, x, y, s], z) {
  return [p[0] + 2 * (x * s + w * y) * z, p[1] + 2 * (y * s - w * x) * z, p[2] + (1 - 2 * (x * x + y * y)) * z];
}

function geometryOf(form, count, shapes) {
  // Many small balls need fewer corners each than a few large ones.
  const fine = count <= 300 ? 40 : count <= 2000 ? 20 : 8;
  if (form === 'sphere') return new THREE.SphereGeometry(1, fine, Math.round(fine * 0.6));
  if (form === 'box') return new THREE.BoxGeometry(2, 2, 2);
  if (form === 'cylinder') return new THREE.CylinderGeometry(1, 1, 2, fine).rotateX(Math.PI / 2);
  if (form === 'plane') return new THREE.PlaneGeometry(400, 400);
  const shape = shapes.get(form.slice(5));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(shape.vertices, 3));
  geometry.setIndex(shape.triangles);
  // Each triangle has its own normal: edges of gears stay sharp.
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

const kFewPixels = { sphere: 24, box: 3 }; // radius below which a disc is drawn instead
const kMany = 300;                        // balls or boxes from which on that counts

// All instances of one form. Those that the camera cannot see are left out of each picture, and small ones are discs.
class Bucket {
  constructor(form, parts, shapes, material) {
    this.parts = parts; // { prop, position, rotation, scale, color }
    this.geometry = geometryOf(form, parts.length, shapes);
    this.isPlane = form === 'plane';
    this.geometry.computeBoundingSphere();
    this.prop = Int32Array.from(parts, (part) => part.prop);
    this.local = new Float32Array(10 * parts.length);
    parts.forEach((part, i) => this.local.set([...part.position, ...part.rotation, ...part.scale], 10 * i));
    const size = this.geometry.boundingSphere.center.length() + this.geometry.boundingSphere.radius;
    this.radius = Float32Array.from(parts, (part) => size * Math.max(...part.scale));
    this.color = Float32Array.from(parts.flatMap((part) => new THREE.Color().setRGB(...part.color, THREE.SRGBColorSpace).toArray()));
    this.mesh = this.makeMesh(this.geometry, material);
    this.fewPixels = kFewPixels[form];
    this.dots = this.fewPixels && parts.length > kMany ? new Dots(parts.length, this) : null;
    this.drawn = this.dots ? [this.mesh, this.dots.points] : [this.mesh];
  }

  makeMesh(geometry, material) {
    const mesh = new THREE.InstancedMesh(geometry, material, this.parts.length);
    mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    mesh.instanceColor = new THREE.InstancedBufferAttribute(new Float32Array(3 * this.parts.length), 3);
    mesh.instanceColor.setUsage(THREE.DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.castShadow = !this.isPlane;
    mesh.receiveShadow = true;
    mesh.userData = { bucket: this, shown: new Int32Array(this.parts.length) };
    return mesh;
  }

  // The matrix of part i by the poses of all props (seven numbers each), into out[m ..]. What is not there has size zero.
  write(i, poses, out, m) {
    const { local } = this, l = 10 * i, at = 7 * this.prop[i];
    const w = poses[at + 3], x = poses[at + 4], y = poses[at + 5], z = poses[at + 6];
    const bw = local[l + 3], bx = local[l + 4], by = local[l + 5], bz = local[l + 6];
    const qw = w * bw - x * bx - y * by - z * bz, qx = w * bx + x * bw + y * bz - z * by;
    const qy = w * by - x * bz + y * bw + z * bx, qz = w * bz + x * by - y * bx + z * bw;
    const px = local[l], py = local[l + 1], pz = local[l + 2];
    const tx = 2 * (y * pz - z * py), ty = 2 * (z * px - x * pz), tz = 2 * (x * py - y * px);
    const gone = w === 0 && x === 0 && y === 0 && z === 0;
    const sx = gone ? 0 : local[l + 7], sy = gone ? 0 : local[l + 8], sz = gone ? 0 : local[l + 9];
    out[m] = (1 - 2 * (qy * qy + qz * qz)) * sx; out[m + 1] = 2 * (qx * qy + qw * qz) * sx; out[m + 2] = 2 * (qx * qz - qw * qy) * sx; out[m + 3] = 0;
    out[m + 4] = 2 * (qx * qy - qw * qz) * sy; out[m + 5] = (1 - 2 * (qx * qx + qz * qz)) * sy; out[m + 6] = 2 * (qy * qz + qw * qx) * sy; out[m + 7] = 0;
    out[m + 8] = 2 * (qx * qz + qw * qy) * sz; out[m + 9] = 2 * (qy * qz - qw * qx) * sz; out[m + 10] = (1 - 2 * (qx * qx + qy * qy)) * sz; out[m + 11] = 0;
    out[m + 12] = poses[at] + px + w * tx + y * tz - z * ty;
    out[m + 13] = poses[at + 1] + py + w * ty + z * tx - x * tz;
    out[m + 14] = poses[at + 2] + pz + w * tz + x * ty - y * tx;
    out[m + 15] = 1;
  }

  // With shadows all are meshes, which throw them.
  // `eye`: { planes: of what is seen, 4 numbers each; at: [x, y, z]; pixels: that a metre has at a metre }.
  update(poses, eye, wantsAll) {
    const { mesh, dots, color } = this, { planes, at, pixels } = eye, out = mesh.instanceMatrix.array, { shown } = mesh.userData;
    let n = 0;
    dots?.begin();
    for (let i = 0; i < this.prop.length; ++i) {
      const m = 16 * n, r = this.radius[i], c = 3 * i;
      this.write(i, poses, out, m);
      const x = out[m + 12], y = out[m + 13], z = out[m + 14];
      let isSeen = true;
      if (!wantsAll) for (let k = 0; isSeen && k < planes.length; k += 4) isSeen = planes[k] * x + planes[k + 1] * y + planes[k + 2] * z + planes[k + 3] > -r;
      if (!isSeen) continue;
      if (dots && !wantsAll && r * pixels < this.fewPixels * Math.hypot(x - at[0], y - at[1], z - at[2])) {
        // A box is about as large as a ball of 0.6 of its diagonal.
        if (out[m] !== 0 || out[m + 1] !== 0 || out[m + 2] !== 0) dots.add(i, x, y, z, this.fewPixels === kFewPixels.box ? 0.6 * r : r, color[c], color[c + 1], color[c + 2]);
        continue;
      }
      mesh.instanceColor.array.set(color.subarray(c, c + 3), 3 * n);
      shown[n++] = i;
    }
    dots?.end(pixels);
    mesh.count = n;
    mesh.visible = n > 0;
    for (const [attribute, width] of [[mesh.instanceMatrix, 16], [mesh.instanceColor, 3]]) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, width * n);
      attribute.needsUpdate = true;
    }
    mesh.boundingSphere = null;
  }

  dispose() {
    this.mesh.dispose();
    this.geometry.dispose();
    this.dots?.dispose();
  }
}

export class Props {
  constructor(group) {
    this.group = group;
    this.material = new THREE.MeshLambertMaterial();
    this.buckets = [];
    this.objects = [];
    this.poses = new Float32Array(0);
    this.places = null;
  }

  // Everything anew: after a change of the structure.
  rebuild(model) {
    for (const bucket of this.buckets) {
      this.group.remove(...bucket.drawn);
      bucket.dispose();
    }
    this.objects = [...model.objects.values()];
    this.index = new Map(this.objects.map((object, i) => [object.id, i]));
    this.poses = new Float32Array(7 * this.objects.length);
    const byForm = new Map();
    this.objects.forEach((object, prop) => {
      const color = colorOf(object);
      let parts = object.shapes.flatMap((id) => (model.shapes.has(id) ? partsOfShape(model.shapes.get(id)) : []));
      if (object.kind === 'shaft' && object.shapes.length === 0) parts = axleParts(object);
      for (const part of parts) {
        if (!byForm.has(part.form)) byForm.set(part.form, []);
        byForm.get(part.form).push({ color, ...part, prop });
      }
      this.setPose(prop, object.position, object.orientation);
    });
    this.buckets = [...byForm].map(([form, parts]) => new Bucket(form, parts, model.shapes, this.material));
    for (const bucket of this.buckets) this.group.add(...bucket.drawn);
    this.layout = null;
  }

  setPose(prop, p, q) { this.poses.set([...p, ...q], 7 * prop); }

  // For a picture from `eye` (see Bucket); with shadows, what is not seen may throw one.
  show(eye, wantsAll) { for (const bucket of this.buckets) bucket.update(this.poses, eye, wantsAll); }

  // Moves everything to a moment between two frames.
  place(moment) {
    if (this.layout !== moment.b.layout || this.run !== moment.b.run) this.bind(moment.b);
    for (let i = 0; i < this.movers.length; i += 2) mixBody(moment, this.movers[i + 1], this.poses, 7 * this.movers[i]);
    for (const { prop, place, axle } of this.turners) {
      const half = mixAngle(moment, place) / 2, c = Math.cos(half), s = Math.sin(half), [w, x, y, z] = axle;
      const at = 7 * prop + 3;
      this.poses[at] = w * c - z * s;
      this.poses[at + 1] = x * c + y * s;
      this.poses[at + 2] = y * c - x * s;
      this.poses[at + 3] = z * c + w * s;
    }
  }

  // Which object is at which place of the frames.
  bind(frame) {
    this.layout = frame.layout;
    this.run = frame.run;
    const movers = [];
    this.turners = [];
    this.objects.forEach((object, prop) => {
      const place = object.kind === 'shaft' ? this.layout.shafts.get(object.handle) : this.layout.bodies.get(object.handle);
      if (place === undefined) return;
      if (object.kind === 'shaft') this.turners.push({ prop, place, axle: object.orientation });
      else movers.push(prop, place);
    });
    this.movers = Int32Array.from(movers);
  }

  positionOf(id) {
    const prop = this.index?.get(id);
    return prop === undefined ? null : this.poses.subarray(7 * prop, 7 * prop + 3);
  }

  poseOf(id) {
    const prop = this.index?.get(id);
    return prop === undefined ? null : this.poses.subarray(7 * prop, 7 * prop + 7);
  }

  // Parts of an object: { geometry, write(array) }.
  partsOf(id) {
    const prop = this.index?.get(id), out = [];
    for (const bucket of this.buckets)
      for (let i = 0; i < bucket.prop.length; ++i)
        if (bucket.prop[i] === prop) out.push({ geometry: bucket.geometry, write: (array) => bucket.write(i, this.poses, array, 0) });
    return out;
  }

  // The object under a ray, and where; null: none.
  pick(raycaster) {
    let found = null;
    const offer = (bucket, part, distance, point) => {
      if (!found || distance < found.distance) found = { id: this.objects[bucket.prop[part]].id, distance, point };
    };
    const hit = raycaster.intersectObjects(this.buckets.map((bucket) => bucket.mesh).filter((mesh) => mesh.count > 0), false)[0];
    if (hit) offer(hit.object.userData.bucket, hit.object.userData.shown[hit.instanceId], hit.distance, hit.point);
    for (const bucket of this.buckets) {
      const dot = bucket.dots?.pick(raycaster.ray);
      if (dot) offer(bucket, dot.part, dot.distance, dot.point);
    }
    return found;
  }

  // Ball around everything but planes: { center, radius }.
  bounds() {
    const box = new THREE.Box3(), matrix = new THREE.Matrix4(), part = new THREE.Box3();
    for (const bucket of this.buckets) {
      if (bucket.isPlane) continue;
      bucket.geometry.computeBoundingBox();
      for (let i = 0; i < bucket.prop.length; ++i) {
        bucket.write(i, this.poses, matrix.elements, 0);
        box.union(part.copy(bucket.geometry.boundingBox).applyMatrix4(matrix));
      }
    }
    const sphere = new THREE.Sphere(new THREE.Vector3(0, 0, 0), 2);
    return box.isEmpty() ? sphere : box.getBoundingSphere(sphere);
  }
}
