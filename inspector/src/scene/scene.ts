// SPDX-License-Identifier: Apache-2.0
// Draws poses, points, arrows and chains of joints. A bundle of its own; see load.ts.
import { AmbientLight, ArrowHelper, AxesHelper, BufferGeometry, Color, CylinderGeometry, DirectionalLight, Float32BufferAttribute, GridHelper, Group, Line, LineBasicMaterial, Mesh, MeshLambertMaterial, PerspectiveCamera, Quaternion, Scene as ThreeScene, SphereGeometry, Spherical, Vector3, WebGLRenderer, type Object3D } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Shape, Vec3 } from "./poses.js";

export interface Scene {
  /** What is there from now on: shapes, and chains as points that links connect. */
  show(shapes: readonly Shape[], chains: readonly (readonly Vec3[])[]): void;
  render(): void;
  /** Turns by so many radians around and up, and goes as many times as far away: for keys. */
  turn(around: number, up: number, farther: number): void;
  /** Takes the colors of the page again. */
  recolor(): void;
  dispose(): void;
}

const height = 300;
const trail = 400;

function color(name: string): Color {
  return new Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim() || "#888");
}

/** Makes a scene in an element. Throws where there is no WebGL. */
export function makeScene(place: HTMLElement): Scene {
  const renderer = new WebGLRenderer({ antialias: true });
  renderer.setPixelRatio(Math.min(2, devicePixelRatio));
  place.append(renderer.domElement);
  const scene = new ThreeScene();
  const camera = new PerspectiveCamera(45, 1, 0.01, 1000);
  camera.up.set(0, 0, 1);
  camera.position.set(2, -2.5, 1.8);
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.enableDamping = false;
  let isDirty = true;
  controls.addEventListener("change", () => {
    isDirty = true;
  });
  scene.add(new AmbientLight(0xffffff, 1.2));
  const sun = new DirectionalLight(0xffffff, 2);
  sun.position.set(1, -2, 4);
  scene.add(sun, new AxesHelper(0.3));
  let grid = makeGrid();
  const content = new Group();
  scene.add(content);
  const trails = new Map<string, Vec3[]>();
  let isFramed = false;

  function makeGrid(): GridHelper {
    scene.background = color("--field");
    const made = new GridHelper(4, 20, color("--text-quiet"), color("--grid"));
    // Grids of the library lie in x and z; here z points up.
    made.rotateX(Math.PI / 2);
    scene.add(made);
    return made;
  }

  const sized = new ResizeObserver(() => {
    const width = Math.max(100, place.clientWidth);
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    isDirty = true;
  });
  sized.observe(place);

  function follow(label: string, position: Vec3): void {
    const points = trails.get(label) ?? [];
    trails.set(label, points);
    points.push(position);
    if (points.length > trail) points.shift();
    if (points.length < 2) return;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(points.flat(), 3));
    content.add(new Line(geometry, new LineBasicMaterial({ color: color("--accent") })));
  }

  /** Looks at all that is there, once. */
  function frame(points: readonly Vec3[]): void {
    if (isFramed || points.length === 0) return;
    isFramed = true;
    const size = Math.max(0.5, ...points.map((point) => Math.hypot(...point)));
    camera.position.set(1.4 * size, -1.8 * size, 1.3 * size);
    controls.target.set(0, 0, size * 0.3);
    controls.update();
  }

  return {
    show: (shapes, chains) => {
      clear(content);
      const points: Vec3[] = [];
      for (const shape of shapes) {
        if (shape.kind === "joints") continue;
        const made = objectOf(shape);
        content.add(made);
        if (shape.kind === "arrow") points.push(shape.direction);
        else {
          points.push(shape.position);
          follow(shape.label, shape.position);
        }
      }
      for (const chain of chains) {
        content.add(links(chain));
        points.push(...chain);
      }
      frame(points);
      isDirty = true;
    },
    render: () => {
      if (!isDirty) return;
      isDirty = false;
      renderer.render(scene, camera);
    },
    turn: (around, up, farther) => {
      const from = camera.position.clone().sub(controls.target);
      const seen = new Spherical().setFromVector3(from.applyAxisAngle(new Vector3(1, 0, 0), -Math.PI / 2));
      seen.theta += around;
      seen.phi -= up;
      seen.radius *= farther;
      seen.makeSafe();
      camera.position.copy(controls.target).add(from.setFromSpherical(seen).applyAxisAngle(new Vector3(1, 0, 0), Math.PI / 2));
      controls.update();
      isDirty = true;
    },
    recolor: () => {
      scene.remove(grid);
      clear(grid);
      grid = makeGrid();
      isDirty = true;
    },
    dispose: () => {
      sized.disconnect();
      controls.dispose();
      clear(content);
      renderer.dispose();
      renderer.forceContextLoss();
      renderer.domElement.remove();
    },
  };
}

function objectOf(shape: Exclude<Shape, { kind: "joints" }>): Object3D {
  switch (shape.kind) {
    case "pose": {
      const axes = new AxesHelper(0.15);
      const [w, x, y, z] = shape.orientation;
      axes.position.set(...shape.position);
      axes.quaternion.copy(new Quaternion(x, y, z, w));
      return axes;
    }
    case "point": {
      const ball = new Mesh(new SphereGeometry(0.02, 12, 8), new MeshLambertMaterial({ color: color("--accent") }));
      ball.position.set(...shape.position);
      return ball;
    }
    case "arrow": {
      const direction = new Vector3(...shape.direction);
      const length = direction.length();
      return new ArrowHelper(length > 0 ? direction.clone().normalize() : new Vector3(1, 0, 0), new Vector3(), Math.max(length, 1e-6), color("--accent"));
    }
  }
}

/** Links as cylinders, joints as balls. */
function links(points: readonly Vec3[]): Group {
  const group = new Group();
  const link = new MeshLambertMaterial({ color: color("--line-1") });
  const joint = new MeshLambertMaterial({ color: color("--line-2") });
  points.forEach((point, i) => {
    const ball = new Mesh(new SphereGeometry(0.035, 16, 12), joint);
    ball.position.set(...point);
    group.add(ball);
    const next = points[i + 1];
    if (!next) return;
    const from = new Vector3(...point);
    const along = new Vector3(...next).sub(from);
    const length = along.length();
    if (length < 1e-9) return;
    const bar = new Mesh(new CylinderGeometry(0.022, 0.022, length, 12), link);
    bar.position.copy(from).addScaledVector(along, 0.5);
    bar.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
    group.add(bar);
  });
  return group;
}

/** Takes all out and gives back what the graphics card holds. */
function clear(group: Object3D): void {
  group.traverse((one) => {
    const { geometry, material } = one as Partial<Mesh>;
    geometry?.dispose();
    for (const each of Array.isArray(material) ? material : material ? [material] : []) each.dispose();
  });
  group.clear();
}
