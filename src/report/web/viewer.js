// The 3-D view of a report page. It reads the particles from <script id="fppg-scene">, which
// src/report/scene.cpp writes, and builds itself inside <div id="fppg-view">.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

// A particle is a disc that is shaded as a sphere; `cut` removes what is beyond a plane.
const vertexShader = `
uniform vec3 low;
uniform vec3 extent;
uniform vec3 cutAxis;
uniform float cutAt;
uniform float pixels;
void main() {
  vec3 at = (modelMatrix * vec4(low + extent * position, 1.0)).xyz;
  gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
  gl_PointSize = max(pixels, 1.0);
  if (dot(at, cutAxis) > cutAt) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;
const fragmentShader = `
precision mediump float;
uniform vec3 colour;
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0;
  float squared = dot(at, at);
  if (squared > 1.0) discard;
  vec3 normal = vec3(at.x, -at.y, sqrt(1.0 - squared));
  float light = 0.35 + 0.65 * max(dot(normal, normalize(vec3(-0.4, 0.5, 0.75))), 0.0);
  gl_FragColor = vec4(colour * light, 1.0);
}`;

const directions = {
  iso: [0.45, -0.78, 0.43], front: [0, -1, 0], right: [1, 0, 0], above: [0, -1e-4, 1],
};

const markHex = '#e6007e';
const markColour = [0.9, 0, 0.49];

function uint16s(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Uint16Array(bytes.buffer);
}

function element(parent, tag, text, attributes) {
  const out = document.createElement(tag);
  if (text !== undefined) out.textContent = text;
  for (const name in attributes || {}) out.setAttribute(name, attributes[name]);
  parent.appendChild(out);
  return out;
}

class View {
  constructor(home, scene) {
    this.sets = scene.sets;
    this.views = scene.views;
    this.hidden = new Set();
    this.cut = { axis: 1, share: 0 };
    this.renderer = new THREE.WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setClearColor(0xffffff, 1);
    this.renderer.setScissorTest(true);
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1);
    this.camera.up.set(0, 0, 1);
    this.buildPage(home);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.draw());
    window.addEventListener('resize', () => this.resize());
    this.show(0);
  }

  buildPage(home) {
    const bar = element(home, 'div', undefined, { class: 'bar' });
    if (this.views.length > 1) {
      this.select = element(bar, 'select', undefined, { 'aria-label': 'what is shown' });
      this.views.forEach((view, i) => element(this.select, 'option', view.title, { value: i }));
      this.select.addEventListener('change', () => this.show(Number(this.select.value)));
    }
    for (const name of Object.keys(directions))
      element(bar, 'button', name, { type: 'button' })
        .addEventListener('click', () => this.look(directions[name]));
    const label = element(bar, 'label', 'cut across ');
    const axis = element(label, 'select', undefined, { 'aria-label': 'axis of the cut' });
    ['x', 'y', 'z'].forEach((name, i) => element(axis, 'option', name, { value: i }));
    axis.value = '1';
    this.slider = element(label, 'input', undefined,
      { type: 'range', min: 0, max: 1, step: 0.005, value: 1, 'aria-label': 'place of the cut' });
    const update = () => {
      const at = Number(this.slider.value);
      // What is nearest to the usual eye goes first: large x and z, small y.
      this.cut = { axis: Number(axis.value), share: axis.value === '1' ? 1 - at : at };
      this.draw();
    };
    axis.addEventListener('change', update);
    this.slider.addEventListener('input', update);
    this.buildTime(bar);
    this.canvasHome = element(home, 'div', undefined, { class: 'canvas' });
    this.canvasHome.appendChild(this.renderer.domElement);
    this.titles = element(this.canvasHome, 'div', undefined, { class: 'titles' });
    this.legend = element(home, 'div', undefined, { class: 'legend' });
    if (this.sets.some((set) => set.marks))
      this.markText = element(home, 'p', '', { class: 'marks' });
  }

  // Where sets have a motion: a slider of its time, and a button that plays it.
  buildTime(bar) {
    this.end = Math.max(0, ...this.sets.map((set) => set.end || 0));
    this.time = 0;
    if (!(this.end > 0)) return;
    const label = element(bar, 'label', 'time ');
    const slider = element(label, 'input', undefined,
      { type: 'range', min: 0, max: 1, step: 0.001, value: 0, 'aria-label': 'time of the motion' });
    const text = element(label, 'span', '0 s');
    const button = element(bar, 'button', 'play', { type: 'button' });
    const go = (share) => {
      this.time = share;
      slider.value = String(share);
      text.textContent = `${(share * this.end).toPrecision(3)} s`;
      this.draw();
    };
    slider.addEventListener('input', () => go(Number(slider.value)));
    let playing = false;
    const step = () => {
      if (!playing) return;
      go(this.time >= 1 ? 0 : Math.min(1, this.time + 0.004));
      window.requestAnimationFrame(step);
    };
    button.addEventListener('click', () => {
      playing = !playing;
      button.textContent = playing ? 'stop' : 'play';
      step();
    });
  }

  // Puts a part where it is at the time of the slider.
  place(points) {
    const frames = points.userData.frames;
    if (!frames) return;
    const share = Math.min(1, this.time * this.end / points.userData.end);
    const f = frames[Math.round(share * (frames.length - 1))];
    points.matrix.set(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9], f[10], f[11],
      0, 0, 0, 1);
    points.matrixWorldNeedsUpdate = true;
  }

  // Discs at places that are marked; over all else, or where nothing stands before them.
  markObject(set, places, isOverAll) {
    const low = new THREE.Vector3();
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position',
      new THREE.BufferAttribute(new Float32Array(places.flat()), 3));
    const material = new THREE.ShaderMaterial({
      vertexShader, fragmentShader, depthTest: !isOverAll, transparent: true,
      uniforms: {
        low: { value: low }, extent: { value: new THREE.Vector3(1, 1, 1) }, pixels: { value: 1 },
        colour: { value: new THREE.Vector3(...markColour) },
        cutAxis: { value: new THREE.Vector3() }, cutAt: { value: 0 },
      },
    });
    const points = new THREE.Points(geometry, material);
    points.frustumCulled = false;
    points.matrixAutoUpdate = false;
    points.renderOrder = 1;
    points.userData = { label: set.marks.label, dp: set.dp };
    return points;
  }

  // An object a frame that has marks, and one of the start.
  addMarks(set) {
    const byFrame = new Map();
    for (const mark of set.marks.places) {
      if (!byFrame.has(mark.frame)) byFrame.set(mark.frame, []);
      byFrame.get(mark.frame).push(mark);
    }
    for (const [frame, marks] of byFrame) {
      const points = this.markObject(set, marks.map((mark) => mark.at), true);
      Object.assign(points.userData, { frame, frameCount: set.marks.frames, least: 13,
        texts: marks.map((mark) => mark.text) });
      set.group.add(points);
    }
    if (set.marks.start.length === 0) return;
    const points = this.markObject(set, set.marks.start, false);
    Object.assign(points.userData, { frame: 0, frameCount: set.marks.frames, least: 3, texts: [] });
    set.group.add(points);
  }

  // Whether it is no mark, or one of the frame that is shown.
  isNow(points) {
    const of = points.userData;
    return of.frame === undefined || of.frame === Math.round(this.time * (of.frameCount - 1));
  }

  // Particles of one set, an object a part, so that a part can be hidden.
  objects(index) {
    const set = this.sets[index];
    if (set.group) return set.group;
    const low = new THREE.Vector3(...set.box.slice(0, 3));
    const extent = new THREE.Vector3(...set.box.slice(3)).sub(low);
    const positions = uint16s(set.positions);
    delete set.positions;
    set.group = new THREE.Group();
    let begin = 0;
    for (const part of set.parts) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position',
        new THREE.BufferAttribute(positions.subarray(3 * begin, 3 * (begin + part.count)), 3, true));
      begin += part.count;
      const material = new THREE.ShaderMaterial({
        vertexShader, fragmentShader,
        uniforms: {
          low: { value: low }, extent: { value: extent }, pixels: { value: 1 },
          colour: { value: new THREE.Vector3(...[1, 3, 5].map(
            (at) => parseInt(part.colour.slice(at, at + 2), 16) / 255)) },
          cutAxis: { value: new THREE.Vector3() }, cutAt: { value: 0 },
        },
      });
      const points = new THREE.Points(geometry, material);
      points.frustumCulled = false;
      points.matrixAutoUpdate = false;
      points.userData = { label: part.label, dp: set.dp, frames: part.frames, end: set.end };
      set.group.add(points);
    }
    if (set.marks) this.addMarks(set);
    return set.group;
  }

  show(number) {
    this.view = this.views[number];
    if (this.select) this.select.value = String(number);
    this.panels = this.view.sets.map((index) => {
      const scene = new THREE.Scene();
      scene.add(this.objects(index));
      return scene;
    });
    this.box = new THREE.Box3();
    for (const index of this.view.sets) {
      const box = this.sets[index].box;
      this.box.expandByPoint(new THREE.Vector3(...box.slice(0, 3)));
      this.box.expandByPoint(new THREE.Vector3(...box.slice(3)));
    }
    for (const scene of this.panels) {
      const corners = this.box.clone();
      scene.add(new THREE.Box3Helper(corners, 0xaaaaaa));
    }
    this.titles.textContent = '';
    this.view.sets.forEach((index, i) =>
      element(this.titles, 'span', this.view.names[i] || this.sets[index].name));
    this.buildLegend();
    const size = this.box.getSize(new THREE.Vector3());
    this.look(size.y <= 1e-6 * size.length() ? directions.front : directions.iso);
  }

  buildLegend() {
    this.legend.textContent = '';
    this.hidden.clear();
    const known = new Map();
    for (const index of this.view.sets) {
      for (const part of this.sets[index].parts) known.set(part.label, part);
      const marks = this.sets[index].marks;
      if (marks) known.set(marks.label, { colour: markHex });
    }
    for (const [label, part] of known) {
      const button = element(this.legend, 'button', undefined,
        { type: 'button', 'aria-pressed': 'true', title: 'hide or show', 'data-label': label });
      element(button, 'i', '', { style: `background:${part.colour}` });
      button.appendChild(document.createTextNode(label));
      button.addEventListener('click', () => {
        if (!this.hidden.delete(label)) this.hidden.add(label);
        button.setAttribute('aria-pressed', String(!this.hidden.has(label)));
        this.draw();
      });
    }
  }

  // Puts the eye in a direction from the middle, so far that all is in front of it.
  look(direction) {
    const middle = this.box.getCenter(new THREE.Vector3());
    this.radius = Math.max(0.5 * this.box.getSize(new THREE.Vector3()).length(), 1e-9);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle)
      .addScaledVector(new THREE.Vector3(...direction).normalize(), 3 * this.radius);
    this.camera.near = 0;
    this.camera.far = 6 * this.radius;
    this.camera.zoom = 1;
    this.camera.lookAt(middle);
    this.resize();
    this.controls.update();
  }

  resize() {
    const width = this.canvasHome.clientWidth;
    const height = this.canvasHome.clientHeight;
    this.renderer.setSize(width, height);
    const aspect = width / this.panels.length / Math.max(height, 1);
    // Seen from the eye, the box fills the panel.
    this.camera.updateMatrixWorld(true);
    const inverse = this.camera.matrixWorld.clone();
    if (inverse.invert) inverse.invert();
    else inverse.getInverse(this.camera.matrixWorld);
    let x = 0;
    let y = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const at = new THREE.Vector3(
        corner & 1 ? this.box.max.x : this.box.min.x, corner & 2 ? this.box.max.y : this.box.min.y,
        corner & 4 ? this.box.max.z : this.box.min.z).applyMatrix4(inverse);
      x = Math.max(x, Math.abs(at.x));
      y = Math.max(y, Math.abs(at.y));
    }
    const half = 1.08 * Math.max(y, x / aspect, 1e-9);
    this.camera.top = half;
    this.camera.bottom = -half;
    this.camera.right = half * aspect;
    this.camera.left = -half * aspect;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    const canvas = this.renderer.domElement;
    const width = canvas.clientWidth / this.panels.length;
    const height = canvas.clientHeight;
    const metre = height * this.camera.zoom / (this.camera.top - this.camera.bottom) *
      this.renderer.getPixelRatio();
    const axis = ['x', 'y', 'z'][this.cut.axis];
    const sign = this.cut.axis === 1 ? -1 : 1;
    const margin = 0.002 * this.radius;
    const low = this.box.min[axis] - margin;
    const high = this.box.max[axis] + margin;
    const cutAxis = new THREE.Vector3();
    cutAxis[axis] = sign;
    const cutAt = sign * (low + this.cut.share * (high - low));
    const texts = [];
    this.panels.forEach((scene, i) => {
      for (const points of scene.children[0].children) {
        const uniforms = points.material.uniforms;
        uniforms.pixels.value = Math.max(metre * points.userData.dp, points.userData.least || 0);
        uniforms.cutAxis.value.copy(cutAxis);
        uniforms.cutAt.value = cutAt;
        points.visible = !this.hidden.has(points.userData.label) && this.isNow(points);
        if (points.visible && points.userData.texts) texts.push(...points.userData.texts);
        this.place(points);
      }
      this.renderer.setViewport(i * width, 0, width, height);
      this.renderer.setScissor(i * width, 0, width, height);
      this.renderer.render(scene, this.camera);
    });
    if (this.markText) this.markText.textContent = texts.join('; ');
  }
}

const home = document.getElementById('fppg-view');
try {
  const view = new View(home, JSON.parse(document.getElementById('fppg-scene').textContent));
  // Pictures of runs choose what is shown.
  for (const link of document.querySelectorAll('[data-view]'))
    link.addEventListener('click', () => {
      view.show(Number(link.dataset.view));
      home.scrollIntoView({ behavior: 'smooth', block: 'nearest' });
    });
} catch (error) {
  home.textContent = `There is no 3-D view: this browser does not draw with WebGL (${error.message}).`;
}
