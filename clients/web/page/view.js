// The picture: camera, light, shadows, mouse, and the loop that draws.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Marks } from './marks.js';
import { Props } from './props.js';

const kSlow = 22; // pictures/s, below which shadows are left out, and then pixels

// Without a graphics processor smooth edges cost more than anything else.
function isDrawnBySoftware() {
  const gl = document.createElement('canvas').getContext('webgl2'), info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class View {
  // hand: { grab(id, position, force), move(position), release(), push(id, impulse, point) }
  constructor(canvas, model, poses, socket, hand) {
    Object.assign(this, { canvas, model, poses, socket, hand });
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !isDrawnBySoftware() });
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(4, -6, 3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.makeLight();
    this.props = new Props(this.scene);
    this.marks = new Marks(this.scene, this.props, model);
    this.raycaster = new THREE.Raycaster();
    this.shadows = 'auto';
    this.mode = 'look'; // or 'grab', 'push': what a drag on a body does
    this.follow = false;
    this.pending = 0;   // messages of poses that are not acknowledged yet
    this.pictures = 0;
    this.times = [];
    this.listen();
    this.frame = (now) => {
      this.draw(now);
      requestAnimationFrame(this.frame);
    };
    requestAnimationFrame(this.frame);
  }

  makeLight() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f99, 1.6));
    this.sun = new THREE.DirectionalLight(0xffffff, 2.2);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.02;
    this.scene.add(this.sun, this.sun.target);
    this.grid = new THREE.GridHelper(1, 1);
    this.ground = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.ShadowMaterial({ opacity: 0.22 }));
    this.ground.receiveShadow = true;
    this.scene.add(this.grid, this.ground);
  }

  listen() {
    this.model.on('begin', () => {
      this.marks.clear();
      this.wantsCamera = this.model.isOther;
    });
    this.model.on('run', () => {
      this.marks.clear();
      this.poses.moments.splice(0, this.poses.moments.length - 1);
    });
    this.model.on('structure', () => { this.isStale = true; });
    this.model.on('selected', (id) => {
      this.marks.select(id);
      this.isChanged = true;
    });
    this.model.on('metrics', () => { this.isChanged ||= this.model.outputs.size > 0; });
    this.model.on('contacts', () => { this.isChanged ||= this.marks.show.forces; });
    this.model.on('collisions', (entries) => {
      this.marks.takeCollisions(entries);
      this.isChanged = true;
    });
    this.canvas.addEventListener('pointerdown', (event) => this.press(event), true);
    this.canvas.addEventListener('pointermove', (event) => this.drag(event));
    this.canvas.addEventListener('pointerup', (event) => this.lift(event));
    this.canvas.addEventListener('pointercancel', () => this.letGo());
    this.canvas.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width < 2 || height < 2) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.fitLens();
    this.isChanged = true;
  }

  setBackground(background, lines, force, impact) {
    this.scene.background = new THREE.Color(background);
    this.marks.pressing.setColours(force, impact);
    this.lineColor = lines;
    this.isChanged = true;
    this.fitGround();
  }

  // ---- Poses ----

  take(buffer) {
    const moment = this.poses.add(buffer);
    ++this.pending;
    return moment;
  }

  rebuild() {
    this.isStale = false;
    this.props.rebuild(this.model);
    this.placed = null;
    const moment = this.poses.between(performance.now());
    if (moment) this.props.place(moment);
    this.marks.rebuild();
    this.ball = this.props.bounds();
    if (this.wantsCamera && this.model.scene) {
      const cameras = this.model.scene.cameras;
      const first = cameras.find((camera) => camera.name === 'front') ?? cameras[0];
      if (first) this.useCamera(first);
      else this.fitAll();
      this.wantsCamera = false;
    }
    this.fitGround();
    this.fitSun();
    this.isChanged = true;
  }

  // ---- Camera ----

  // A camera of a scene is meant for pictures that are wider than high: where the picture is narrower, it shows as much from side to side.
  fitLens() {
    const half = Math.tan((this.fieldOfView ?? 0.7) / 2) * Math.max(1, 1.6 / this.camera.aspect);
    this.camera.fov = (2 * Math.atan(half) * 180) / Math.PI;
    this.camera.updateProjectionMatrix();
  }

  useCamera(camera) {
    this.fieldOfView = camera.field_of_view;
    this.fitLens();
    this.camera.position.set(...camera.position);
    this.controls.target.set(...camera.look_at);
    this.fitDepth();
  }

  fitAll() {
    const ball = this.ball ?? this.props.bounds();
    const away = (1.15 * Math.max(ball.radius, 0.1)) / Math.sin((this.camera.fov * Math.PI) / 360);
    this.controls.target.copy(ball.center);
    this.camera.position.set(0.45, -0.8, 0.4).normalize().multiplyScalar(away).add(ball.center);
    this.fitDepth();
  }

  lookAt(id) {
    const at = this.props.positionOf(id);
    if (!at) return;
    const offset = this.camera.position.clone().sub(this.controls.target);
    this.controls.target.set(...at);
    this.camera.position.copy(this.controls.target).add(offset);
  }

  fitDepth() {
    const far = this.camera.position.distanceTo(this.ball?.center ?? new THREE.Vector3()) + (this.ball?.radius ?? 10);
    this.camera.far = Math.max(50, 8 * far);
    this.camera.near = this.camera.far / 20000;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  fitGround() {
    const radius = Math.max(1, this.ball?.radius ?? 2), center = this.ball?.center ?? new THREE.Vector3();
    const cell = Math.pow(10, Math.round(Math.log10(radius / 3))), cells = Math.min(200, 2 * Math.ceil((3 * radius) / cell));
    this.scene.remove(this.grid);
    this.grid.dispose();
    this.grid = new THREE.GridHelper(cells * cell, cells, this.lineColor, this.lineColor);
    this.grid.rotation.x = Math.PI / 2;
    this.grid.position.set(Math.round(center.x / cell) * cell, Math.round(center.y / cell) * cell, 0);
    this.grid.visible = ![...this.model.objects.values()].some((o) => o.shapes.some((id) => this.model.shapes.get(id)?.form === 'plane'));
    this.ground.scale.setScalar(cells * cell);
    this.ground.position.copy(this.grid.position);
    this.ground.visible = this.grid.visible;
    this.scene.add(this.grid);
  }

  fitSun() {
    const { center, radius } = this.ball, shadow = this.sun.shadow.camera, reach = Math.max(0.5, radius * 1.1);
    this.sun.position.set(0.35, -0.45, 1).normalize().multiplyScalar(3 * reach).add(center);
    this.sun.target.position.copy(center);
    Object.assign(shadow, { left: -reach, right: reach, top: reach, bottom: -reach, near: reach, far: 6 * reach });
    shadow.updateProjectionMatrix();
  }

  // ---- The loop ----

  draw(now) {
    // Acknowledged here: a page that is hidden or slow gets no more than it draws.
    for (; this.pending > 0; --this.pending) this.socket.acknowledge();
    if (this.isStale) this.rebuild();
    const moment = this.poses.between(now);
    if (moment && this.props.buckets.length > 0) this.place(moment);
    this.followSelection();
    if (!this.camera.position.equals(this.drawnFrom ?? this.controls.target) || !this.controls.target.equals(this.drawnTo)) this.isChanged = true;
    if (this.isChanged || this.marks.isAlive) this.paint(now);
    this.measure(now);
  }

  // A scene that stands still, seen by a camera that does, is not drawn again.
  paint(now) {
    this.isChanged = false;
    this.drawnFrom = this.camera.position.clone();
    this.drawnTo = this.controls.target.clone();
    const away = this.camera.position.distanceTo(this.controls.target);
    this.sun.castShadow = this.shadows === 'on' || (this.shadows === 'auto' && !this.tooSlow);
    this.camera.updateMatrixWorld();
    this.props.show(this.eye(), this.sun.castShadow);
    this.marks.update(now, 0.22 * away, 0.008 * away);
    this.renderer.render(this.scene, this.camera);
    ++this.pictures;
  }

  eye() {
    const seen = new THREE.Frustum().setFromProjectionMatrix(new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse));
    const pixels = this.renderer.domElement.height / (2 * Math.tan((this.camera.fov * Math.PI) / 360));
    return { planes: seen.planes.flatMap((plane) => [...plane.normal.toArray(), plane.constant]), at: this.camera.position.toArray(), pixels };
  }

  place(moment) {
    const same = this.placed && this.placed.a === moment.a && this.placed.b === moment.b && this.placed.share === moment.share;
    if (same) return;
    this.props.place(moment);
    this.placed = moment;
    this.isChanged = true;
    this.shownTime = moment.a.time + moment.share * (moment.b.time - moment.a.time);
  }

  followSelection() {
    const at = this.follow && this.model.selected ? this.props.positionOf(this.model.selected) : null;
    if (!at) {
      this.followed = null;
      return;
    }
    const now = new THREE.Vector3(...at);
    if (this.followed?.id === this.model.selected) {
      const moved = now.clone().sub(this.followed.at);
      this.camera.position.add(moved);
      this.controls.target.add(moved);
    }
    this.followed = { id: this.model.selected, at: now };
    this.controls.update();
  }

  measure(end) {
    this.times.push(end);
    while (this.times[0] < end - 3000) this.times.shift();
    // Where pictures take long, shadows go, then pixels; they stay away: a picture that flickers is worse.
    if (end - (this.judgedAt ?? end) < 2500) {
      this.judgedAt ??= end;
      return;
    }
    this.judgedAt = end;
    if (document.hidden || this.picturesPerSecond >= kSlow) return;
    if (!this.tooSlow) this.tooSlow = true;
    else if (this.renderer.getPixelRatio() > 0.5) {
      this.renderer.setPixelRatio(Math.max(0.5, 0.7 * this.renderer.getPixelRatio()));
      this.resize();
    }
  }

  // Over the last two seconds.
  get picturesPerSecond() {
    const now = performance.now(), first = this.times.findIndex((time) => time > now - 2000);
    return first < 0 ? 0 : (this.times.length - first) / 2;
  }

  // ---- Mouse and keys ----

  ray(event) {
    const box = this.canvas.getBoundingClientRect();
    const place = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    this.raycaster.setFromCamera(place, this.camera);
    return this.raycaster;
  }

  press(event) {
    if (event.button !== 0) return;
    this.pressed = { x: event.clientX, y: event.clientY };
    const mode = event.shiftKey ? 'grab' : event.altKey ? 'push' : this.mode;
    if (mode === 'look') return;
    const hit = this.props.pick(this.ray(event)), object = hit && this.model.objects.get(hit.id);
    if (!object || object.motion !== 'dynamic' || object.kind === 'shaft') return;
    event.stopPropagation();
    this.model.select(hit.id);
    if (mode === 'push') return this.hand.push(hit.id, this.raycaster.ray.direction.toArray(), hit.point.toArray());
    const center = new THREE.Vector3(...this.props.positionOf(hit.id)), facing = this.camera.getWorldDirection(new THREE.Vector3());
    this.held = { plane: new THREE.Plane().setFromNormalAndCoplanarPoint(facing, hit.point), offset: center.sub(hit.point) };
    this.controls.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
    this.hand.grab(hit.id, this.held.offset.clone().add(hit.point).toArray());
  }

  drag(event) {
    if (!this.held) return;
    const point = this.ray(event).ray.intersectPlane(this.held.plane, new THREE.Vector3());
    if (point) this.hand.move(point.add(this.held.offset).toArray());
  }

  lift(event) {
    if (this.held) return this.letGo();
    if (!this.pressed || Math.hypot(event.clientX - this.pressed.x, event.clientY - this.pressed.y) > 4) return;
    this.model.select(this.props.pick(this.ray(event))?.id ?? null);
  }

  letGo() {
    if (!this.held) return;
    this.held = null;
    this.controls.enabled = true;
    this.hand.release();
  }

  key(event) {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    const zooms = { '+': 0.9, '=': 0.9, '-': 1 / 0.9 };
    const offset = this.camera.position.clone().sub(this.controls.target);
    if (turns[event.key]) {
      const [around, down] = turns[event.key], ball = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
      ball.theta += around;
      ball.phi = Math.min(Math.PI - 0.05, Math.max(0.05, ball.phi + down));
      const turned = new THREE.Vector3().setFromSpherical(ball);
      offset.set(turned.x, -turned.z, turned.y);
    } else if (zooms[event.key]) offset.multiplyScalar(zooms[event.key]);
    else return;
    event.preventDefault();
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }
}
