// SPDX-License-Identifier: Apache-2.0

/** Red, green, blue; 0 is dark, 1 is a lamp's full power. */
export type Color = readonly [red: number, green: number, blue: number];
/** In metres: x to the east, y to the north, z up from the floor. */
export type Place = readonly [x: number, y: number, z: number];

export const pictureWidth = 320;
export const pictureHeight = 240;
const height = 3;
// Half of what one camera covers: a quarter of the floor.
const halfWidth = 2;
const halfDepth = 1.5;

const grid = (xs: number[], ys: number[], z: number): Place[] => ys.flatMap((y) => xs.map((x): Place => [x, y, z]));
export const lightPlaces = grid([1.5, 4, 6.5], [1.5, 4.5], height);
export const sensorPlaces = grid([1.2, 6.8], [1.2, 4.8], 0.8);
export const cameraPlaces = grid([2, 6], [4.5, 1.5], height);

/** The color of what lies at a place on the floor: tiles, two tables, a round rug. */
function surface(x: number, y: number): Color {
  const isInside = (left: number, bottom: number, right: number, top: number): boolean => x >= left && x < right && y >= bottom && y < top;
  if (isInside(0.6, 0.8, 2.2, 1.7) || isInside(5.9, 4.3, 7.6, 5.3)) return [0.72, 0.52, 0.33];
  if (Math.hypot(x - 4, y - 3) < 1.1) return [0.35, 0.45, 0.62];
  return (Math.floor(x * 2) + Math.floor(y * 2)) % 2 === 0 ? [0.85, 0.85, 0.82] : [0.66, 0.66, 0.68];
}

/** Bright parts are compressed instead of cut off, so that a lamp's color stays visible below it. */
function exposed(light: number, reflectance: number): number {
  return Math.round(255 * (1 - Math.exp(-14 * light * reflectance)));
}

/** The simulated room of ../../cpp/room.hpp: 8 x 6 x 3 m, all of it computed from the lamps' colors. */
export class Room {
  readonly lights: Color[] = lightPlaces.map(() => [0.4, 0.4, 0.4]);

  /** Sets the lamps first to last, counted from 1. */
  setLights(first: number, last: number, color: Color): void {
    this.lights.fill(color, first - 1, last);
  }

  /** What a sensor measures, counted from 0: light from all lamps that reaches it. */
  sensor(index: number): Color {
    return this.illumination(sensorPlaces[index] ?? [0, 0, 0]);
  }

  /** What a camera sees of the floor below it: three bytes a pixel, rows from the north, pixels from the west. */
  picture(camera: number): Uint8Array {
    const [centerX, centerY] = cameraPlaces[camera] ?? [0, 0];
    const rgb = new Uint8Array(3 * pictureWidth * pictureHeight);
    let next = 0;
    for (let row = 0; row < pictureHeight; ++row) {
      const y = centerY + halfDepth * (1 - (2 * row + 1) / pictureHeight);
      for (let column = 0; column < pictureWidth; ++column) {
        const x = centerX + halfWidth * ((2 * column + 1) / pictureWidth - 1);
        const light = this.illumination([x, y, 0]);
        const floor = surface(x, y);
        for (const channel of [0, 1, 2] as const) rgb[next++] = exposed(light[channel], floor[channel]);
      }
    }
    return rgb;
  }

  /** On a level surface: each lamp by the inverse square of its distance and the cosine at the lamp and at the surface. */
  private illumination([x, y, z]: Place): Color {
    let [red, green, blue] = [0, 0, 0];
    this.lights.forEach((light, i) => {
      const [lampX, lampY, lampZ] = lightPlaces[i] ?? [0, 0, 0];
      const dz = lampZ - z;
      const square = (lampX - x) ** 2 + (lampY - y) ** 2 + dz * dz;
      const weight = (dz * dz) / (square * square);
      red += light[0] * weight;
      green += light[1] * weight;
      blue += light[2] * weight;
    });
    return [red, green, blue];
  }
}
