// SPDX-License-Identifier: Apache-2.0
import { once } from "node:events";
import { RRNode } from "@robdef/runtime";
import { CameraHostSkeleton } from "./generated/RobotCameraHost_interface.js";
import { Host } from "./host.js";
import { Room } from "./room.js";

const usage = `usage: smart_room_service [--port N] [--seconds N] [--everywhere]
Serves the simulated smart room until it is interrupted, or for so many seconds.
  --port N      TCP port, 0 for any free one (default 6257)
  --everywhere  for clients of other machines, too; without it of this one only`;

interface Settings {
  port: number;
  seconds: number;
  isEverywhere: boolean;
}

function settingsOf(words: string[]): Settings | undefined {
  const settings = { port: 6257, seconds: 0, isEverywhere: false };
  for (let word = words.shift(); word !== undefined; word = words.shift()) {
    if (word === "--everywhere") {
      settings.isEverywhere = true;
      continue;
    }
    const value = words.shift() ?? "";
    if (!/^\d{1,9}$/.test(value)) return undefined;
    if (word === "--port" && Number(value) <= 65535) settings.port = Number(value);
    else if (word === "--seconds") settings.seconds = Number(value);
    else return undefined;
  }
  return settings;
}

async function serve({ port, seconds, isEverywhere }: Settings): Promise<void> {
  const stop = new AbortController();
  const end = (): void => {
    stop.abort();
  };
  process.once("SIGINT", end).once("SIGTERM", end);
  const node = new RRNode({ name: "RobotCameraHost" });
  try {
    node.registerService("CameraHost", new CameraHostSkeleton(new Host(new Room())));
    const used = await node.listen({ port, ...(isEverywhere ? { host: "*" } : {}) });
    console.error(`listens at port ${used} of ${isEverywhere ? "all interfaces" : "this machine; --everywhere opens it to others"}`);
    console.log(`ready: tcp://localhost:${used}/RobotCameraHost/CameraHost`);
    if (seconds > 0) setTimeout(end, 1000 * seconds).unref();
    if (!stop.signal.aborted) await once(stop.signal, "abort");
  } finally {
    await node.close();
  }
}

const settings = settingsOf(process.argv.slice(2));
if (settings) {
  await serve(settings);
} else {
  console.error(usage);
  process.exitCode = 2;
}
