// SPDX-License-Identifier: Apache-2.0
// What the page knows: connected devices, what is selected, panels, and what was done.
import { effect, signal } from "@preact/signals";
import { RRNode, type Member } from "@robdef/runtime";
import { explainFailure, hostOf, readAddress, serviceAt } from "./address.js";
import { Device, type DeviceObject } from "./device.js";
import { errorText, wordsOf } from "./errors.js";
import { Feeds } from "./feed.js";
import { History, type PathStep } from "./history.js";
import { layoutText, readLayout, type Layout, type MemberPlace, type PanelLayout } from "./layout.js";
import { forgetUrl, recentUrls, rememberUrl } from "./recent.js";
import { listServices, type NodeServices } from "./services.js";
import { openWorkerSocket } from "./worker_socket.js";
import { Recorder } from "../tape/recorder.js";
import type { Tape } from "../tape/tape.js";

/** Why connecting failed, and what can be done. */
export interface ConnectFailure {
  readonly url: string;
  readonly why: string;
  readonly what: readonly string[];
  /** A user has to log in. */
  readonly needsLogin: boolean;
}

/** A part of the page that stays while other objects are looked at. */
export interface Panel {
  readonly id: number;
  readonly kind: PanelLayout["kind"];
  readonly sources: readonly { readonly object: DeviceObject; readonly member: Member }[];
  readonly hidden: readonly string[];
  readonly seconds: number;
}

/** How old what is shown in plots is, at most, unless changed. */
export const firstSeconds = 10;

/** The part of a browser that the page stands on; tests give another one. */
export interface Platform {
  readonly protocol: string;
  readonly origin: string;
  readonly storage: Storage | undefined;
  /** Whether something answers HTTP at a URL. */
  answers(url: string): Promise<boolean>;
}

export class App {
  readonly devices = signal<readonly Device[]>([]);
  readonly selected = signal<DeviceObject | undefined>(undefined);
  readonly panels = signal<readonly Panel[]>([]);
  readonly recent = signal<readonly string[]>([]);
  readonly connecting = signal("");
  readonly failure = signal<ConnectFailure | undefined>(undefined);
  readonly notice = signal("");
  /** Whether properties are asked for again and again. */
  readonly live = signal(true);
  readonly services = signal<NodeServices | undefined>(undefined);
  readonly tape = signal<Tape | undefined>(undefined);
  /** Said by screen readers when it changes. */
  readonly announcement = signal("");
  readonly history = new History();
  readonly feeds = new Feeds();
  readonly recorder = new Recorder();
  readonly node: RRNode;
  private lastPanel = 0;

  constructor(readonly platform: Platform) {
    const open = this.recorder.around(openWorkerSocket);
    this.node = new RRNode({ openers: { "rr+ws": open, "rr+wss": open } });
    this.recent.value = recentUrls(platform.storage);
  }

  /** What was written in the address field, or is in a list. */
  async connect(written: string, login?: { readonly user: string; readonly password: string }): Promise<Device | undefined> {
    const address = readAddress(written);
    this.failure.value = undefined;
    this.notice.value = "";
    if (address.kind === "unusable") {
      this.fail(written, address.why, []);
      return undefined;
    }
    this.connecting.value = address.url;
    try {
      if (address.kind === "node") {
        await this.showServices(address.url);
        return undefined;
      }
      this.notice.value = address.note ?? "";
      const known = this.devices.value.find((one) => one.url === address.url);
      const device = known ?? new Device(this.node, address.url, this.history);
      if (known?.state.value === "open") {
        this.selected.value = known.root.value;
        return known;
      }
      await device.connect(login);
      if (!known) this.devices.value = [...this.devices.value, device];
      this.recent.value = rememberUrl(this.platform.storage, address.url);
      this.selected.value = device.root.value;
      this.services.value = undefined;
      this.announcement.value = `Connected to ${device.title}`;
      return device;
    } catch (error) {
      await this.explain(address.url, error);
      return undefined;
    } finally {
      this.connecting.value = "";
    }
  }

  private async explain(url: string, error: unknown): Promise<void> {
    const { name, text, hint } = wordsOf(error);
    if (name !== "ConnectionError") {
      this.fail(url, `${name}: ${text}`, hint === undefined ? [] : [hint], name === "AuthenticationError");
      return;
    }
    const http = url.replace(/^rr\+ws/, "http").replace(/\?.*$/, "");
    const { protocol, origin } = this.platform;
    const answers = await this.platform.answers(http);
    const { why, what } = explainFailure(url, text, { protocol, origin, answers });
    this.fail(url, why, what);
  }

  private fail(url: string, why: string, what: readonly string[], needsLogin = false): void {
    this.failure.value = { url, why, what, needsLogin };
    this.announcement.value = `Cannot connect. ${why}`;
  }

  private async showServices(url: string): Promise<void> {
    this.services.value = await listServices(this.node, url);
    this.announcement.value = `${hostOf(url)} has ${this.services.value.services.length} services`;
  }

  /** Looks whether the node that served the page has services, and lists them. */
  async discover(host: string, isSecure: boolean): Promise<void> {
    const url = serviceAt(`${isSecure ? "rr+wss" : "rr+ws"}://${host}/?service=x`, "RobotRaconteurServiceIndex");
    try {
      await this.showServices(url);
    } catch {
      // The page is from another kind of server.
    }
  }

  /** Records all connections from now on. */
  startRecording(): void {
    this.recorder.start(this.definitionTexts());
    // So that the recording tells what types the objects are of.
    for (const device of this.devices.value) {
      const visit = (object: DeviceObject): void => {
        device.client?.findObjectType(object.path).catch(() => undefined);
        object.children.value.forEach(visit);
      };
      if (device.state.value === "open" && device.root.value) visit(device.root.value);
    }
    this.announcement.value = "Recording";
  }

  /** Ends, and gives the file. */
  stopRecording(): Uint8Array<ArrayBuffer> | undefined {
    this.recorder.define(this.definitionTexts());
    return this.recorder.stop();
  }

  private definitionTexts(): string[] {
    return this.devices.value.flatMap((device) => [...(device.client?.definitions.values() ?? [])]);
  }

  forget(url: string): void {
    this.recent.value = forgetUrl(this.platform.storage, url);
  }

  async reconnect(device: Device): Promise<void> {
    const steps = this.selected.value?.device === device ? this.selected.value.steps : [];
    try {
      await device.connect();
      this.selected.value = (await device.root.value?.follow(steps)) ?? device.root.value;
      this.failure.value = undefined;
    } catch (error) {
      await this.explain(device.url, error);
    }
  }

  async disconnect(device: Device): Promise<void> {
    this.panels.value = this.panels.value.filter((panel) => !panel.sources.some(({ object }) => object.device === device));
    if (this.selected.value?.device === device) this.selected.value = undefined;
    this.devices.value = this.devices.value.filter((one) => one !== device);
    await device.close();
  }

  /** Shows members in a new panel, or adds lines to a plot that is there. */
  show(kind: Panel["kind"], object: DeviceObject, member: Member): void {
    const plot = kind === "plot" ? this.panels.value.find((panel) => panel.kind === "plot") : undefined;
    if (plot) {
      if (!plot.sources.some((one) => one.object === object && one.member.name === member.name)) {
        this.change(plot, { sources: [...plot.sources, { object, member }] });
      }
      return;
    }
    this.add(kind, [{ object, member }]);
  }

  add(kind: Panel["kind"], sources: Panel["sources"], layout?: PanelLayout): void {
    const panel: Panel = { id: ++this.lastPanel, kind, sources, hidden: layout?.hidden ?? [], seconds: layout?.seconds ?? firstSeconds };
    this.panels.value = [...this.panels.value, panel];
    this.announcement.value = `Added a ${kind}`;
  }

  change(panel: Panel, change: Partial<Panel>): void {
    this.panels.value = this.panels.value.map((one) => (one.id === panel.id ? { ...one, ...change } : one));
  }

  remove(panel: Panel): void {
    this.panels.value = this.panels.value.filter((one) => one.id !== panel.id);
  }

  /** What the page shows, for its URL. */
  layout(): Layout {
    const place = (object: DeviceObject, member: Member): MemberPlace => ({ url: object.device.url, steps: object.steps, member: member.name });
    const selected = this.selected.value;
    return {
      urls: this.devices.value.map((device) => device.url),
      ...(selected ? { selected: { url: selected.device.url, steps: selected.steps } } : {}),
      panels: this.panels.value.map(({ kind, sources, hidden, seconds }) => ({
        kind,
        places: sources.map(({ object, member }) => place(object, member)),
        ...(hidden.length > 0 ? { hidden } : {}),
        ...(seconds === firstSeconds ? {} : { seconds }),
      })),
    };
  }

  /** Connects and shows what a layout says. What is not there any more is left out, and said. */
  async restore(layout: Layout): Promise<void> {
    for (const url of layout.urls) await this.connect(url);
    const objectAt = async (url: string, steps: readonly PathStep[]): Promise<DeviceObject | undefined> => {
      const root = this.devices.value.find((device) => device.url === url)?.root.value;
      return await root?.follow(steps);
    };
    try {
      if (layout.selected) this.selected.value = (await objectAt(layout.selected.url, layout.selected.steps)) ?? this.selected.value;
      for (const panel of layout.panels) {
        const sources: { object: DeviceObject; member: Member }[] = [];
        for (const place of panel.places) {
          const object = await objectAt(place.url, place.steps);
          const member = object?.remote.type.members.get(place.member);
          if (object && member) sources.push({ object, member });
        }
        if (sources.length > 0) this.add(panel.kind, sources, panel);
      }
    } catch (error) {
      this.notice.value = `Not everything of this link is there any more: ${errorText(error)}`;
    }
  }

  /** Keeps the layout in the URL of the page from now on. */
  keepLayout(write: (hash: string) => void): void {
    effect(() => {
      write(layoutText(this.layout()));
    });
  }

  /** The layout of a link that was opened. */
  static layoutIn(hash: string): Layout {
    return readLayout(hash);
  }
}
