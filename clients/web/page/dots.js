// Bodies that are small in the picture, as lit discs: one vertex each, however many there are. A ball looks as it does as a mesh.
import * as THREE from 'three';

const kVertex = `
  attribute float radius;
  attribute vec3 tint;
  uniform float pixels;
  uniform vec3 sun;
  varying vec3 vTint, vSun, vUp;
  void main() {
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * at;
    gl_PointSize = max(1.5, 2.0 * radius * pixels / max(1e-6, -at.z));
    vTint = tint;
    vSun = normalize((viewMatrix * vec4(sun, 0.0)).xyz);
    vUp = normalize((viewMatrix * vec4(0.0, 0.0, 1.0, 0.0)).xyz);
  }`;

// The lights of view.js, as three.js adds them up.
const kFragment = `
  varying vec3 vTint, vSun, vUp;
  void main() {
    vec2 p = 2.0 * gl_PointCoord - 1.0;
    float square = dot(p, p);
    if (square > 1.0) discard;
    vec3 normal = vec3(p.x, -p.y, sqrt(1.0 - square));
    float sky = 0.5 * dot(normal, vUp) + 0.5;
    vec3 light = vec3(0.70 * max(0.0, dot(normal, vSun))) + 0.51 * mix(vec3(0.26, 0.27, 0.32), vec3(1.0), sky);
    gl_FragColor = vec4(vTint * light, 1.0);
    #include <colorspace_fragment>
  }`;

export class Dots {
  constructor(most, bucket) {
    const attribute = (width) => new THREE.BufferAttribute(new Float32Array(width * most), width).setUsage(THREE.DynamicDrawUsage);
    this.geometry = new THREE.BufferGeometry();
    this.attributes = { position: attribute(3), radius: attribute(1), tint: attribute(3) };
    for (const [name, values] of Object.entries(this.attributes)) this.geometry.setAttribute(name, values);
    this.material = new THREE.ShaderMaterial({ vertexShader: kVertex, fragmentShader: kFragment, uniforms: { pixels: { value: 1 }, sun: { value: new THREE.Vector3(0.35, -0.45, 1) } } });
    this.points = new THREE.Points(this.geometry, this.material);
    this.points.frustumCulled = false;
    this.points.userData = { bucket };
    this.shown = new Int32Array(most);
    this.count = 0;
  }

  // Between begin() and end() comes everything that is shown.
  begin() { this.count = 0; }

  add(part, x, y, z, radius, r, g, b) {
    const n = this.count++, { position, tint } = this.attributes;
    this.shown[n] = part;
    position.array[3 * n] = x; position.array[3 * n + 1] = y; position.array[3 * n + 2] = z;
    tint.array[3 * n] = r; tint.array[3 * n + 1] = g; tint.array[3 * n + 2] = b;
    this.attributes.radius.array[n] = radius;
  }

  end(pixels) {
    this.material.uniforms.pixels.value = pixels;
    this.geometry.setDrawRange(0, this.count);
    this.points.visible = this.count > 0;
    for (const values of Object.values(this.attributes)) {
      values.clearUpdateRanges();
      values.addUpdateRange(0, values.itemSize * this.count);
      values.needsUpdate = true;
    }
  }

  // The nearest under a ray: { part, distance }; null: none.
  pick(ray) {
    let found = null;
    const sphere = new THREE.Sphere(), point = new THREE.Vector3(), { position, radius } = this.attributes;
    for (let n = 0; n < this.count; ++n) {
      sphere.center.fromArray(position.array, 3 * n);
      sphere.radius = radius.array[n];
      if (!ray.intersectSphere(sphere, point)) continue;
      const distance = point.distanceTo(ray.origin);
      if (!found || distance < found.distance) found = { part: this.shown[n], distance, point: point.clone() };
    }
    return found;
  }

  dispose() {
    this.geometry.dispose();
    this.material.dispose();
  }
}
