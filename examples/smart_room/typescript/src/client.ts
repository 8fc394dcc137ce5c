// SPDX-License-Identifier: Apache-2.0
// Does with the smart room what the paper does from MATLAB: connects by URL, sets lamps, reads sensors, takes a picture.
import { RRError, RRNode } from "@robdef/runtime";
import { CameraHostStub } from "./generated/RobotCameraHost_interface.js";
import { writePng } from "./png.js";

const usage = `usage: smart_room_client [URL] [--picture FILE.png]
Uses the smart room at URL (default rr+tcp://localhost:6257/?service=CameraHost).`;

function printColors(what: string, values: Float64Array): void {
  console.log(`${what}:`);
  for (let i = 0; i + 2 < values.length; i += 3) {
    const [red, green, blue] = Array.from(values.subarray(i, i + 3), (one) => one.toFixed(3));
    console.log(`  ${i / 3}  red ${red}  green ${green}  blue ${blue}`);
  }
}

async function use(node: RRNode, url: string, pictureFile: string | undefined): Promise<void> {
  const { root: room } = await node.connect(url, CameraHostStub);
  console.log(`connected to ${url}: ${await room.getRobotDeviceCount()} devices, ${await room.getRobotCameraCount()} cameras`);

  const lights = await room.getRobdevice(0);
  const sensors = await room.getRobdevice(1);
  const camera = await room.getRobcamera(2);
  console.log(`device 0 is \`${await lights.getName()}\`, device 1 is \`${await sensors.getName()}\`, camera 2 is \`${await camera.getName()}\``);

  printColors("sensors before", await sensors.getProperty("ReadRGB"));
  await lights.setProperty("SetRGBRange", [1, 2, 0.7, 0.3, 0]);
  console.log("lamps 1 to 2 set to red 0.7, green 0.3, blue 0");
  printColors("sensors after", await sensors.getProperty("ReadRGB"));

  const frame = await camera.getCurrentStreamFrameCameraBitmap();
  if (!frame) throw new Error("the camera gave no picture");
  console.log(`a picture of ${frame.width} x ${frame.height} pixels`);
  if (pictureFile !== undefined) {
    writePng(pictureFile, frame.width, frame.height, frame.data);
    console.log(`written to ${pictureFile}`);
  }

  try {
    await lights.setProperty("SetRGBRange", [1, 99, 0, 0, 0]);
  } catch (error) {
    if (!(error instanceof RRError)) throw error;
    console.log(`lamp 99 is refused by the service: ${error.errorName}: ${error.message}`);
  }
}

async function main(words: string[]): Promise<number> {
  let url = "rr+tcp://localhost:6257/?service=CameraHost";
  let pictureFile: string | undefined;
  for (let word = words.shift(); word !== undefined; word = words.shift()) {
    if (word === "--picture" && words.length > 0) pictureFile = words.shift();
    else if (!word.startsWith("-")) url = word;
    else {
      console.error(usage);
      return 2;
    }
  }
  const node = new RRNode();
  try {
    await use(node, url, pictureFile);
    return 0;
  } catch (error) {
    console.error(`smart_room_client: ${String(error)}`);
    return 1;
  } finally {
    await node.close();
  }
}

process.exitCode = await main(process.argv.slice(2));
