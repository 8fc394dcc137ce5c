// SPDX-License-Identifier: Apache-2.0
// A service with everything that the inspector shows, for its tests: all kinds of members and types, 20 wires, a camera,
// a robot, and one whose every text tries to become HTML.
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { Definitions, MultiDimArray, PasswordUsers, RRNode, RRError, ErrorCode, ServedObject, VarValue, type ObjectHandlers } from "@robdef/runtime/node";

export const workshopText = `## A bench with instruments, for tests.
service experimental.workshop
stdver 0.10
exception Jammed
enum Mode
    ## Nothing moves.
    idle = 0,
    jog,
    automatic = 10
end
namedarray Vec
    field double x
    field double y
    field double z
end
pod Sample
    field uint32 number
    field double[3] values
end
struct Settings
    ## In millimetres.
    field double width
    field Mode mode
    field string label
    field bool enabled
    field int64 serial
    field uint8[] bytes
    field double[2,3] matrix
    field double[*] block
    field Vec place
    field Sample[] samples
    field string{string} notes
    field int32{int32} counts
    field Vec{list} path
    field varvalue anything
end
object Tool
    property string name
    ## Force of the grip, in newtons.
    property double force
    function void grip(double force)
end
object Bench
    ## How fast the belt runs [m/s].
    property double speed
    property Mode mode
    property Settings settings
    property int64 ticks [readonly]
    property string secret [writeonly]
    property cdouble impedance
    ## Adds two numbers.
    function double add(double a, double b)
    function Settings mirror(Settings settings)
    function void fail(string how)
    function double slow(double seconds)
    ## Counts up to a limit.
    function int32{generator} count(int32 limit)
    function double{generator} scale(double factor, double{generator} values)
    event moved(double to, string why)
    ## The position of the belt, in metres.
    wire double position [readonly]
    wire Vec where [readonly]
    wire double demand
    pipe double[] waves [readonly]
    pipe string chat
    callback double advise(string question)
    memory double[] table
    memory uint8[*] picture
    objref Tool tool
    objref Tool[] tools
    objref Tool{string} named_tools
${Array.from({ length: 20 }, (_, i) => `    wire double channel_${i} [readonly]`).join("\n")}
end
`;

/** Of the user alice. */
export const workshopPassword = "pass phrase 4711";

export const hostileName = '<img src=x onerror="globalThis.pwned=1">';

export const hostileText = `## ${hostileName}<script>globalThis.pwned=2</script>
service experimental.hostile
stdver 0.10
struct Bait
    ## ${hostileName}
    field string text
end
object Trap
    ## ${hostileName} <svg onload=globalThis.pwned=3> [<b>]
    property string text
    ## javascript:globalThis.pwned=4
    property string{string} texts
    property Bait bait
    function string shout(string word)
    event alarm(string text)
    objref Trap{string} inner
end
`;

export const robotText = `service experimental.cell
stdver 0.10
import com.robotraconteur.geometry
import com.robotraconteur.image
using com.robotraconteur.geometry.Pose
using com.robotraconteur.geometry.Point
using com.robotraconteur.image.Image
object Cell
    wire Pose tcp [readonly]
    property Pose[] frames
    property Point{list} corners
    pipe Image camera [readonly]
    function Image snapshot()
    ## Light of the lamp, from 0 to 1.
    property double lamp
end
`;

const emptySettings = {
  width: 12.5,
  mode: 1,
  label: "belt",
  enabled: true,
  serial: 9007199254740993n,
  bytes: Uint8Array.of(1, 2, 255),
  matrix: new MultiDimArray([2, 3], Float64Array.of(11, 21, 12, 22, 13, 23)),
  block: new MultiDimArray([2, 2], Float64Array.of(1, 3, 2, 4)),
  place: { x: 1, y: 2, z: 3 },
  samples: [{ number: 7, values: Float64Array.of(1, 2, 3) }],
  notes: new Map([["color", "green"]]),
  counts: new Map([[-3, 4]]),
  path: [{ x: 0, y: 0, z: 1 }],
  anything: new VarValue("double[]", Float64Array.of(0.5, 1.5)),
};

/** What a test can do with the services, and see of them. */
export interface Workshop {
  readonly port: number;
  readonly url: (service: string) => string;
  readonly bench: ServedObject;
  readonly trap: ServedObject;
  readonly cell: ServedObject | undefined;
  readonly state: { speed: number; mode: number; settings: unknown; secret: string; lamp: number; chat: string[]; demand: number };
  /** 20 wires with so many values a second; 0 stops. */
  readonly drive: (rate: number) => void;
  readonly close: () => Promise<void>;
}

export interface WorkshopOptions {
  readonly origins?: readonly string[];
  readonly allowLocalPages?: boolean;
  /** Folder of the standard definitions; without it there is no cell. */
  readonly standard?: string | undefined;
}

function toolOf(name: string): ServedObject {
  const values: Record<string, unknown> = { name, force: 1.5 };
  return new ServedObject(new Definitions([workshopText]), "experimental.workshop.Tool", {
    get: (property) => values[property],
    set: (property, value) => {
      values[property] = value;
    },
    call: (_name, [force]) => {
      values.force = force;
      return undefined;
    },
  });
}

export async function startWorkshop({ origins = [], allowLocalPages = false, standard }: WorkshopOptions = {}): Promise<Workshop> {
  const node = new RRNode({ name: "experimental.workshop" });
  const state = { speed: 0.25, mode: 1, settings: emptySettings as unknown, secret: "", lamp: 0.5, chat: [] as string[], demand: 0 };
  const impedance = { re: 50, im: -2 };
  const tools = new Map([0, 1, 2].map((number) => [String(number), toolOf(`tool ${number}`)]));
  const handlers: ObjectHandlers = {
    get: (property) => {
      switch (property) {
        case "ticks":
          return 9223372036854775807n;
        case "impedance":
          return impedance;
        default:
          return state[property as "speed"];
      }
    },
    set: (property, value) => {
      if (property === "speed" && (value as number) > 10) throw new RRError(ErrorCode.OutOfRange, "the belt does not run faster than 10 m/s");
      if (property === "impedance") Object.assign(impedance, value);
      else (state as Record<string, unknown>)[property] = value;
      if (property === "speed") bench.event("moved").fire(value, "speed");
    },
    call: async (name, args) => {
      switch (name) {
        case "add":
          return (args[0] as number) + (args[1] as number);
        case "mirror":
          return args[0];
        case "slow":
          // Nobody waits for it when the test is over.
          await new Promise((resolve) => setTimeout(resolve, (args[0] as number) * 1000).unref());
          return args[0];
        default:
          throw new RRError(ErrorCode.RemoteError, `jammed: ${String(args[0])}`, { errorName: "experimental.workshop.Jammed", subname: "belt" });
      }
    },
    generate: (name, args) =>
      name === "count"
        ? (async function* (): AsyncGenerator<number> {
            for (let i = 1; i <= (args[0] as number); ++i) yield i;
          })()
        : {
            next: (value: unknown) => ({ value: (value as number) * (args[0] as number), done: false }),
          },
    object: (objref, index) => {
      if (objref === "tool") return toolOf("the tool");
      const found = objref === "tools" ? tools.get(String(index)) : toolOf(String(index));
      if (!found) throw new RRError(ErrorCode.ObjectNotFound, `there is no tool ${String(index)}`);
      return found;
    },
  };
  const bench = new ServedObject(new Definitions([workshopText]), "experimental.workshop.Bench", handlers);
  bench.memory("table").store(Float64Array.from({ length: 400 }, (_, i) => Math.sin(i / 20)));
  bench.memory("picture").store(new MultiDimArray([32, 48], Uint8Array.from({ length: 32 * 48 }, (_, i) => (i * 7) % 256)));
  bench.pipe("chat").onConnect((end) => {
    end.onPacket((text) => {
      state.chat.push(String(text));
      end.send(`echo ${String(text)}`);
    });
  });
  bench.wire("demand").onValue((value) => {
    state.demand = value as number;
  });
  const password = createHash("md5").update(workshopPassword).digest("hex");
  node.registerService("bench", bench, { users: new PasswordUsers(`alice ${password} objectlock,clientlock`) });
  node.registerService("guarded", toolOf("guarded"), { users: new PasswordUsers(`alice ${password} objectlock`), requireUser: true });

  const words: Record<string, unknown> = { text: hostileName, texts: new Map([[hostileName, hostileName]]), bait: { text: hostileName } };
  const trapHandlers: ObjectHandlers = {
    get: (property) => words[property],
    set: () => {
      throw new RRError(ErrorCode.RemoteError, hostileName, { errorName: "experimental.hostile.Trap", subname: hostileName });
    },
    call: () => hostileName,
    object: () => new ServedObject(new Definitions([hostileText]), "experimental.hostile.Trap", trapHandlers),
  };
  const trap = new ServedObject(new Definitions([hostileText]), "experimental.hostile.Trap", trapHandlers);
  node.registerService("trap", trap);

  let cell: ServedObject | undefined;
  const timers: ReturnType<typeof setInterval>[] = [];
  if (standard !== undefined) {
    cell = cellOf(standard, state, timers);
    node.registerService("cell", cell);
  }
  const port = await node.listen({ port: 0, webSocket: { origins: [...origins], allowLocalPages } });

  const begin = performance.now();
  timers.push(
    setInterval(() => {
      const t = (performance.now() - begin) / 1000;
      bench.wire("position").send(Math.sin(t));
      bench.wire("where").send({ x: Math.cos(t), y: Math.sin(t), z: t % 1 });
      bench.pipe("waves").broadcast(Float64Array.from({ length: 1000 }, (_, i) => Math.sin(t * 20 + i / 50)));
    }, 20),
  );
  let driving: ReturnType<typeof setInterval> | undefined;
  return {
    port,
    url: (service) => `rr+ws://127.0.0.1:${port}/?service=${service}`,
    bench,
    trap,
    cell,
    state,
    drive: (rate) => {
      clearInterval(driving);
      if (rate === 0) return;
      let sent = 0;
      const start = performance.now();
      driving = setInterval(() => {
        // As many as the time says: timers are late at times. What is very late is left out, or a busy machine would
        // do nothing else.
        const due = Math.floor(((performance.now() - start) / 1000) * rate);
        sent = Math.max(sent, due - rate / 20);
        for (; sent < due; ++sent) for (let i = 0; i < 20; ++i) bench.wire(`channel_${i}`).send(Math.sin((sent / rate) * (1 + i / 10)) + i);
      }, 1);
    },
    close: async () => {
      clearInterval(driving);
      timers.forEach(clearInterval);
      await node.close();
    },
  };
}

const mostWaiting = 4;
const pictureWidth = 640;
const pictureHeight = 480;

function cellOf(standard: string, state: { lamp: number }, timers: ReturnType<typeof setInterval>[]): ServedObject {
  const names = ["geometry", "image", "sensordata", "identifier", "resource", "datetime", "uuid"];
  const texts = names.map((name) => readFileSync(`${standard}/com.robotraconteur.${name}.robdef`, "utf8"));
  let number = 0;
  const picture = (): unknown => {
    const data = new Uint8Array(pictureWidth * pictureHeight * 3);
    const at = number % pictureWidth;
    for (let y = 0, i = 0; y < pictureHeight; ++y) {
      for (let x = 0; x < pictureWidth; ++x, i += 3) {
        data[i] = 255 * state.lamp;
        data[i + 1] = (255 * x) / pictureWidth;
        data[i + 2] = x === at ? 255 : (128 * y) / pictureHeight;
      }
    }
    ++number;
    return { image_info: { data_header: null, height: pictureHeight, width: pictureWidth, step: pictureWidth * 3, encoding: 0x1000, extended: null }, data };
  };
  const pose = (t: number): unknown => ({ orientation: { w: Math.cos(t / 2), x: 0, y: 0, z: Math.sin(t / 2) }, position: { x: 0.5 * Math.cos(t), y: 0.5 * Math.sin(t), z: 0.4 } });
  const cell = new ServedObject(new Definitions([robotText, ...texts]), "experimental.cell.Cell", {
    get: (property) => (property === "lamp" ? state.lamp : property === "frames" ? [pose(0), pose(1)] : [0, 1].map((x) => ({ x, y: 0.5, z: 0 }))),
    set: (_property, value) => {
      state.lamp = value as number;
    },
    call: () => picture(),
  });
  // A client that is slow gets fewer pictures.
  const waiting = new WeakMap<object, number>();
  cell.pipe("camera").onConnect((end) => {
    end.requestsAcknowledgements = true;
    const send = end.send.bind(end);
    end.send = (value) => {
      waiting.set(end, (waiting.get(end) ?? 0) + 1);
      return send(value);
    };
    end.onAcknowledged(() => {
      waiting.set(end, (waiting.get(end) ?? 1) - 1);
    });
  });
  const begin = performance.now();
  timers.push(
    setInterval(() => {
      cell.wire("tcp").send(pose((performance.now() - begin) / 1000));
    }, 20),
    setInterval(() => {
      for (const end of cell.pipe("camera").ends) if ((waiting.get(end) ?? 0) < mostWaiting) end.send(picture());
    }, 1000 / 30),
  );
  return cell;
}
