// A camera on a turntable: yaw and pitch around a target, distance in radii of the model, so that one view fits several
// files. Mouse: turn, pan (right or shift), zoom to the pointer. Touch: one finger turns, two pan and zoom.
import { Matrix4, PerspectiveCamera, Vector3 } from 'three';

export const HOME = { yaw: 35, pitch: 25, distance: 1, target: [0, 0, 0] };
const FIELD_OF_VIEW = 28;

export class Turntable {
  constructor(element, onMove, onTap) {
    this.element = element;
    this.onMove = onMove;
    this.onTap = onTap;
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
    this.up = 'z';
    this.inset = [0, 0];  // CSS pixels at the right and at the bottom that the controls cover
    this.radius = 1;
    this.centre = [0, 0, 0];  // what the target is measured from
    this.reset();
    this.pointers = new Map();
    element.addEventListener('pointerdown', (event) => this.down(event));
    element.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel']) element.addEventListener(name, (event) => this.release(event));
    element.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    element.addEventListener('contextmenu', (event) => event.preventDefault());
  }
  reset() {
    Object.assign(this, HOME, { target: [...HOME.target] });
  }
  /// Axes of the turntable: front, right, up.
  get frame() {
    return this.up === 'z' ? [[0, -1, 0], [1, 0, 0], [0, 0, 1]] : [[0, 0, 1], [1, 0, 0], [0, 1, 0]];
  }
  /// Directions of the view: towards the eye, to the right, upwards.
  get basis() {
    const yaw = (this.yaw * Math.PI) / 180, pitch = (this.pitch * Math.PI) / 180;
    const [front, right, up] = this.frame;
    const mix = (a, b, c) => [0, 1, 2].map((i) => a * front[i] + b * right[i] + c * up[i]);
    return {
      back: mix(Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch)),
      right: mix(-Math.sin(yaw), Math.cos(yaw), 0),
      up: mix(-Math.sin(pitch) * Math.cos(yaw), -Math.sin(pitch) * Math.sin(yaw), Math.cos(pitch)),
    };
  }
  /// Length in the model's space of one CSS pixel at the target.
  get unitsPerPixel() {
    const height = this.element.clientHeight || 1;
    return (2 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360) * this.length) / height;
  }
  /// Distance of the eye; at distance 1 the model's ball fills what is free.
  get length() {
    const half = Math.atan(Math.tan((FIELD_OF_VIEW * Math.PI) / 360) * this.fit);
    return (this.distance * this.radius) / Math.sin(half);
  }
  /// The smaller side of what the controls leave free, over the height.
  get fit() {
    const width = this.element.clientWidth, height = this.element.clientHeight || 1;
    return Math.max(0.1, Math.min(width - this.inset[0], height - this.inset[1]) / height);
  }
  apply(width, height) {
    this.camera.aspect = width / height;
    const { back, right, up } = this.basis;
    const length = this.length, target = this.target.map((x, i) => this.centre[i] + x * this.radius);
    const matrix = new Matrix4().makeBasis(new Vector3(...right), new Vector3(...up), new Vector3(...back));
    matrix.setPosition(...target.map((x, i) => x + length * back[i]));
    this.camera.matrixAutoUpdate = false;
    this.camera.matrix.copy(matrix);
    this.camera.matrixWorldNeedsUpdate = true;
    const reach = this.radius * (1.05 + Math.hypot(...this.target));
    this.camera.near = Math.max(length - reach, length * 0.002);
    this.camera.far = length + reach;
    this.camera.updateProjectionMatrix();
    this.camera.projectionMatrix.elements[8] += this.inset[0] / width;
    this.camera.projectionMatrix.elements[9] -= this.inset[1] / height;
    this.camera.projectionMatrixInverse.copy(this.camera.projectionMatrix).invert();
    this.camera.updateMatrixWorld(true);
  }
  turn(dx, dy) {
    this.yaw = ((((this.yaw - dx * 0.4 + 180) % 360) + 360) % 360) - 180;
    this.pitch = Math.min(90, Math.max(-90, this.pitch + dy * 0.4));
    this.onMove();
  }
  pan(dx, dy) {
    const { right, up } = this.basis, unit = this.unitsPerPixel / this.radius;
    this.target = this.target.map((x, i) => x + unit * (-dx * right[i] + dy * up[i]));
    this.onMove();
  }
  /// Zooms by `factor`, keeping what is at (x, y), in CSS pixels from the centre.
  zoom(factor, x = 0, y = 0) {
    const next = Math.min(20, Math.max(0.002, this.distance * factor));
    const share = 1 - next / this.distance;
    const { right, up } = this.basis, unit = (this.unitsPerPixel / this.radius) * share;
    this.target = this.target.map((t, i) => t + unit * (x * right[i] - y * up[i]));
    this.distance = next;
    this.onMove();
  }
  fromCentre(x, y) {
    const box = this.element.getBoundingClientRect();
    return [x - box.left - (box.width - this.inset[0]) / 2, y - box.top - (box.height - this.inset[1]) / 2];
  }
  down(event) {
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    this.travelled = this.pointers.size > 1 ? Infinity : 0;
    this.element.classList.add('held');
  }
  move(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const dx = event.clientX - last[0], dy = event.clientY - last[1];
    this.travelled += Math.abs(dx) + Math.abs(dy);
    if (this.pointers.size === 1) {
      if (event.buttons & 2 || event.buttons & 4 || event.shiftKey) this.pan(dx, dy);
      else this.turn(dx, dy);
    } else if (this.pointers.size === 2) {
      const [[, other]] = [...this.pointers].filter(([id]) => id !== event.pointerId);
      const before = Math.hypot(last[0] - other[0], last[1] - other[1]);
      const after = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
      this.pan(dx / 2, dy / 2);
      if (before > 0 && after > 0)
        this.zoom(before / after, ...this.fromCentre((event.clientX + other[0]) / 2, (event.clientY + other[1]) / 2));
    }
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }
  release(event) {
    const held = this.pointers.delete(event.pointerId);
    if (this.pointers.size === 0) this.element.classList.remove('held');
    if (held && event.type === 'pointerup' && this.travelled < 4 && event.button === 0) this.onTap(event);
  }
  wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    this.zoom(Math.exp(Math.max(-120, Math.min(120, event.deltaY * lines)) * 0.0022), ...this.fromCentre(event.clientX, event.clientY));
  }
}
