// SPDX-License-Identifier: Apache-2.0
// Poses, points and robots inside of values of the geometry and robotics definitions.
import { MultiDimArray, type ValueType } from "@robdef/runtime";
import { item } from "../model/types.js";

export type Vec3 = readonly [number, number, number];
/** w, x, y, z. */
export type Quaternion = readonly [number, number, number, number];

export type Shape =
  | { readonly kind: "pose"; readonly label: string; readonly position: Vec3; readonly orientation: Quaternion }
  | { readonly kind: "point"; readonly label: string; readonly position: Vec3 }
  | { readonly kind: "arrow"; readonly label: string; readonly direction: Vec3 }
  /** Joints of a chain as positions that lines connect. */
  | { readonly kind: "joints"; readonly label: string; readonly positions: readonly number[] };

/** A kinematic chain of RobotInfo: axes and offsets, for its joints. */
export interface Chain {
  readonly axes: readonly Vec3[];
  readonly offsets: readonly Vec3[];
  readonly joints: readonly number[];
  /** By joint of the chain: whether it slides. */
  readonly slides: readonly boolean[];
}

const geometry = /^com\.robotraconteur\.geometryf?\.(.*)$/;
const robotState = /^com\.robotraconteur\.robotics\.robot\.(?:Advanced)?RobotState(?:SensorData)?$/;
const robotInfo = "com.robotraconteur.robotics.robot.RobotInfo";
const mostShapes = 2000;

/** Whether values of a type have something that 3-D shows. */
export function isPoseType(type: ValueType, depth = 0): boolean {
  const { base } = type;
  if (base.kind !== "record" || depth > 5) return false;
  const known = geometry.exec(base.record.name)?.[1];
  if (known !== undefined && /^(?:Pose|Transform|Point|Vector3|NamedPose|NamedTransform|PoseWithCovariance|NamedPoseWithCovariance)$/.test(known)) return true;
  if (robotState.test(base.record.name) || base.record.name === robotInfo) return true;
  return base.record.kind === "struct" && base.record.fields.some((field) => isPoseType(field.type, depth + 1));
}

type Fields = Readonly<Record<string, unknown>>;

function vec(value: unknown): Vec3 {
  const { x, y, z } = value as Record<string, number>;
  return [x ?? 0, y ?? 0, z ?? 0];
}

function quaternion(value: unknown): Quaternion {
  const { w, x, y, z } = value as Record<string, number>;
  const [a, b, c, d] = [w ?? 0, x ?? 0, y ?? 0, z ?? 0];
  const size = Math.hypot(a, b, c, d);
  // All zero is what an unset pose has.
  return size === 0 || !Number.isFinite(size) ? [1, 0, 0, 0] : [a / size, b / size, c / size, d / size];
}

/** What a value shows. */
export function shapesOf(type: ValueType, value: unknown, label = "", to: Shape[] = [], depth = 0): Shape[] {
  if (value === null || value === undefined || to.length >= mostShapes || depth > 6) return to;
  if (type.container !== "none") {
    const items = value instanceof Map ? [...(value as ReadonlyMap<unknown, unknown>)] : [...(value as unknown[]).entries()];
    for (const [key, one] of items) shapesOf(item(type), one, `${label}[${String(key)}]`, to, depth + 1);
    return to;
  }
  const { base, array } = type;
  if (base.kind !== "record") return to;
  if (array.kind !== "scalar") {
    const row = array.kind === "dims" ? (value as MultiDimArray).array : (value as ArrayLike<unknown>);
    for (let i = 0; i < row.length && to.length < mostShapes; ++i) shapesOf(item(type), row[i], `${label}[${i}]`, to, depth + 1);
    return to;
  }
  const fields = value as Fields;
  switch (geometry.exec(base.record.name)?.[1]) {
    case "Pose":
      to.push({ kind: "pose", label, position: vec(fields.position), orientation: quaternion(fields.orientation) });
      return to;
    case "Transform":
      to.push({ kind: "pose", label, position: vec(fields.translation), orientation: quaternion(fields.rotation) });
      return to;
    case "Point":
      to.push({ kind: "point", label, position: vec(fields) });
      return to;
    case "Vector3":
      to.push({ kind: "arrow", label, direction: vec(fields) });
      return to;
  }
  if (base.record.name === robotInfo) return to;
  if (robotState.test(base.record.name)) {
    const joints = fields.joint_position as ArrayLike<number> | undefined;
    if (joints && joints.length > 0) to.push({ kind: "joints", label, positions: Array.from(joints) });
  }
  for (const field of base.record.fields) {
    if (base.record.kind === "struct") shapesOf(field.type, fields[field.name], label === "" ? field.name : `${label}.${field.name}`, to, depth + 1);
  }
  return to;
}

/** Chains of a RobotInfo. */
export function chainsOf(info: unknown): Chain[] {
  if (typeof info !== "object" || info === null) return [];
  const { chains, joint_info: joints } = info as { chains?: Fields[] | null; joint_info?: Fields[] | null };
  return (chains ?? []).map((chain) => {
    const numbers = Array.from((chain.joint_numbers ?? []) as ArrayLike<number>);
    return {
      axes: ((chain.H ?? []) as unknown[]).map(vec),
      offsets: ((chain.P ?? []) as unknown[]).map(vec),
      joints: numbers,
      slides: numbers.map((number) => joints?.[number]?.joint_type === 3),
    };
  });
}

/** Where the joints of a chain are, the base first and the flange last: product of exponentials. */
export function chainPoints(chain: Chain, positions: readonly number[]): Vec3[] {
  let rotation: Quaternion = [1, 0, 0, 0];
  let at: Vec3 = [0, 0, 0];
  const points: Vec3[] = [at];
  chain.offsets.forEach((offset, i) => {
    at = add(at, rotate(rotation, offset));
    points.push(at);
    const axis = chain.axes[i];
    if (!axis) return;
    const angle = positions[chain.joints[i] ?? i] ?? 0;
    if (chain.slides[i] === true) at = add(at, rotate(rotation, [axis[0] * angle, axis[1] * angle, axis[2] * angle]));
    else rotation = multiply(rotation, about(axis, angle));
  });
  return points;
}

function add(a: Vec3, b: Vec3): Vec3 {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

function about(axis: Vec3, angle: number): Quaternion {
  const sine = Math.sin(angle / 2) / (Math.hypot(...axis) || 1);
  return [Math.cos(angle / 2), axis[0] * sine, axis[1] * sine, axis[2] * sine];
}

function multiply([aw, ax, ay, az]: Quaternion, [bw, bx, by, bz]: Quaternion): Quaternion {
  return [aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw];
}

export function rotate(q: Quaternion, [x, y, z]: Vec3): Vec3 {
  const [, rx, ry, rz] = multiply(multiply(q, [0, x, y, z]), [q[0], -q[1], -q[2], -q[3]]);
  return [rx, ry, rz];
}
