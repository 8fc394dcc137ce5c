// SPDX-License-Identifier: Apache-2.0
// The simulated room as the paper's RobotCameraHost: one host object with devices (lamps and sensors behind one general
// interface) and cameras.
import { InvalidArgument } from "@robdef/runtime";
import type { CameraBitmap, CameraHostService, RobotCameraService, RobotDeviceService } from "./generated/RobotCameraHost_interface.js";
import { cameraPlaces, lightPlaces, pictureHeight, pictureWidth, sensorPlaces, type Room } from "./room.js";

/**
 * All lamps as one device. Properties: `SetRGBRange` takes first and last lamp (from 1), red, green, blue; `GetRGB`
 * gives three numbers a lamp; `Positions` three coordinates a lamp, in metres.
 */
class Lights implements RobotDeviceService {
  constructor(private readonly room: Room) {}

  getName(): string {
    return "RGB lights";
  }

  setName(): void {
    throw new InvalidArgument("the name is fixed");
  }

  getProperty(name: string): number[] {
    if (name === "GetRGB") return this.room.lights.flat();
    if (name === "Positions") return lightPlaces.flat();
    throw new InvalidArgument(`the lights have no property \`${name}\` to get`);
  }

  setProperty(name: string, val: Float64Array): number {
    if (name !== "SetRGBRange") throw new InvalidArgument(`the lights have no property \`${name}\` to set`);
    if (val.length !== 5) throw new InvalidArgument("SetRGBRange takes first, last, red, green, blue");
    const [first = 0, last = 0, red = 0, green = 0, blue = 0] = val;
    if (![red, green, blue].every((color) => color >= 0 && color <= 1)) throw new InvalidArgument("a color is a number from 0 to 1");
    const isLamp = (lamp: number): boolean => Number.isInteger(lamp) && lamp >= 1 && lamp <= lightPlaces.length;
    if (!isLamp(first) || !isLamp(last)) throw new InvalidArgument(`lamps are counted from 1 to ${lightPlaces.length}`);
    if (first > last) throw new InvalidArgument("the first lamp comes behind the last");
    this.room.setLights(first, last, [red, green, blue]);
    return 0;
  }
}

/** All color sensors as one device. Properties: `ReadRGB` gives three numbers a sensor; `Positions` three coordinates, in metres. */
class Sensors implements RobotDeviceService {
  constructor(private readonly room: Room) {}

  getName(): string {
    return "RGB sensors";
  }

  setName(): void {
    throw new InvalidArgument("the name is fixed");
  }

  getProperty(name: string): number[] {
    if (name === "ReadRGB") return sensorPlaces.flatMap((_place, i) => this.room.sensor(i));
    if (name === "Positions") return sensorPlaces.flat();
    throw new InvalidArgument(`the sensors have no property \`${name}\` to get`);
  }

  setProperty(name: string): number {
    throw new InvalidArgument(`the sensors have no property \`${name}\` to set`);
  }
}

/** A ceiling camera. Property: `Position`, in metres. */
class Camera implements RobotCameraService {
  constructor(
    private readonly room: Room,
    private readonly index: number,
  ) {}

  getName(): string {
    return `ceiling camera ${this.index}`;
  }

  setName(): void {
    throw new InvalidArgument("the name is fixed");
  }

  getProperty(name: string): readonly number[] {
    if (name === "Position") return cameraPlaces[this.index] ?? [];
    throw new InvalidArgument(`a camera has no property \`${name}\` to get`);
  }

  setProperty(name: string): number {
    throw new InvalidArgument(`a camera has no property \`${name}\` to set`);
  }

  getCurrentStreamFrameCameraBitmap(): CameraBitmap {
    return { width: pictureWidth, height: pictureHeight, data: this.room.picture(this.index) };
  }
}

export class Host implements CameraHostService {
  private readonly devices: readonly RobotDeviceService[];
  private readonly cameras: readonly RobotCameraService[];

  constructor(room: Room) {
    this.devices = [new Lights(room), new Sensors(room)];
    this.cameras = cameraPlaces.map((_place, i) => new Camera(room, i));
  }

  getRobdevice(index: number): RobotDeviceService {
    return find(this.devices, index, "device");
  }

  getRobcamera(index: number): RobotCameraService {
    return find(this.cameras, index, "camera");
  }

  getRobotDeviceCount(): number {
    return this.devices.length;
  }

  setRobotDeviceCount(): void {
    throw new InvalidArgument("the number of devices is fixed");
  }

  getRobotCameraCount(): number {
    return this.cameras.length;
  }

  setRobotCameraCount(): void {
    throw new InvalidArgument("the number of cameras is fixed");
  }
}

function find<T>(all: readonly T[], index: number, what: string): T {
  const found = all[index];
  if (found === undefined) throw new InvalidArgument(`there is no ${what} ${index}`);
  return found;
}
