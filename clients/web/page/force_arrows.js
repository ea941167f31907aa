// The forces of contacts as arrows: one drawing call, however many there are.
import * as THREE from 'three';

const kMost = 576, kThin = 0.018, kHead = 0.05, kHeadLong = 0.16; // shares of an arrow's length

// From the origin one unit along z.
function arrowShape() {
  const shaft = new THREE.CylinderGeometry(kThin, kThin, 1 - kHeadLong, 6).translate(0, (1 - kHeadLong) / 2, 0);
  const head = new THREE.ConeGeometry(kHead, kHeadLong, 10).translate(0, 1 - kHeadLong / 2, 0);
  const out = new THREE.BufferGeometry(), places = [], indices = [];
  for (const part of [shaft, head]) {
    const first = places.length / 3;
    places.push(...part.attributes.position.array);
    indices.push(...Array.from(part.index.array, (i) => i + first));
    part.dispose();
  }
  out.setAttribute('position', new THREE.Float32BufferAttribute(places, 3));
  out.setIndex(indices);
  return out.rotateX(Math.PI / 2);
}

const length = (v) => Math.hypot(v[0], v[1], v[2]);

export class ForceArrows {
  constructor(group) {
    this.mesh = new THREE.InstancedMesh(arrowShape(), new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 }), kMost);
    this.mesh.frustumCulled = false;
    this.mesh.count = 0;
    this.mesh.renderOrder = 4;
    group.add(this.mesh);
    this.setColours('#1a76e0', '#d81b60');
    this.full = 0; // N: the force whose arrow has the full length
  }

  setColours(lasting, impact) {
    this.lasting = new THREE.Color(lasting);
    this.impact = new THREE.Color(impact);
  }

  // The largest force now; but where nothing presses, no arrow of rounding errors: the mean weight of what moves.
  fit(model) {
    // byHandle is made anew with each change of the structure.
    if (this.weighed !== model.byHandle) {
      const moving = [...model.objects.values()].filter((object) => object.motion === 'dynamic' && object.kind !== 'shaft');
      this.weight = moving.reduce((sum, object) => sum + 9.81 * object.mass, 0) / Math.max(1, moving.length);
      this.weighed = model.byHandle;
    }
    let most = 0;
    for (const point of model.contacts.points) if (!point.isImpact) most = Math.max(most, length(point.force));
    this.full = Math.max(most, 0.97 * this.full, this.weight);
  }

  // `reach`: m that the longest arrow is long. Of a pair the force on the body that moves is drawn, on the second one if both do.
  update(model, reach) {
    this.mesh.count = 0;
    if (!model?.contacts) {
      this.fitted = null;
      this.full = 0;
      return;
    }
    if (this.fitted !== model.contacts) this.fit(model);
    this.fitted = model.contacts;
    const along = new THREE.Vector3(0, 0, 1), direction = new THREE.Vector3(), turn = new THREE.Quaternion(), matrix = new THREE.Matrix4();
    const place = new THREE.Vector3(), size = new THREE.Vector3();
    let n = 0;
    for (const point of model.contacts.points) {
      const force = length(point.force), share = Math.min(1.5, force / this.full);
      if (n >= kMost || !(share > 0.01)) continue;
      const isOnA = point.a === model.selected || (point.b !== model.selected && model.objects.get(point.b)?.motion !== 'dynamic');
      direction.set(...point.force).multiplyScalar((isOnA ? -1 : 1) / force);
      // Short ones stay thick enough to be seen.
      const long = share * reach, thick = Math.max(long, 0.35 * reach);
      matrix.compose(place.set(...point.at), turn.setFromUnitVectors(along, direction), size.set(thick, thick, long));
      this.mesh.setMatrixAt(n, matrix);
      this.mesh.setColorAt(n++, point.isImpact ? this.impact : this.lasting);
    }
    this.mesh.count = n;
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }
}
