// SPDX-License-Identifier: Apache-2.0
// From what a user writes to a URL that a page can use, and from a failure to words.
import { parseUrl } from "@robdef/runtime";

/** The service that every node has: it lists the others. */
export const serviceIndex = "RobotRaconteurServiceIndex";

/** What a text means to a page. */
export type Address =
  /** `note` says what was changed. */
  | { readonly kind: "service"; readonly url: string; readonly note?: string }
  /** A node whose services are wanted: `url` is that of its service index. */
  | { readonly kind: "node"; readonly url: string; readonly host: string }
  | { readonly kind: "unusable"; readonly why: string };

const hostPort = /^(\[[0-9a-fA-F:.]+\]|[a-zA-Z0-9_.-]+)(?::(\d{1,5}))?\/?$/;

/** Schemes that only programs outside of a browser can use, and why. */
const foreign: Readonly<Record<string, string>> = {
  "rr+local": "Local sockets are files of the machine; a page cannot open them. Use the node's TCP port: rr+ws://host:port/?service=name",
  "rr+intra": "This URL is valid inside one program only.",
  "rr+serial": "A page has no serial port. Offer the board with `robdef bridge` and connect to that.",
  "rrs+tcp": "A page cannot use TLS inside of Robot Raconteur's TCP transport. Put the node behind an HTTPS proxy and use rr+wss.",
  "rrs+ws": "A page cannot use TLS inside of a web socket. Put the node behind an HTTPS proxy and use rr+wss.",
  "rrs+wss": "A page cannot use TLS inside of a web socket; rr+wss is encrypted by the browser.",
  "rrs+local": "Local sockets are files of the machine; a page cannot open them.",
};

/** Reads what was written in the address field. */
export function readAddress(written: string): Address {
  const text = written.trim();
  if (text === "") return { kind: "unusable", why: "Enter the URL of a service, or host:port of a node." };
  const plain = hostPort.exec(text.replace(/^(?:https?|wss?):\/\//, ""));
  const isSecure = /^(?:https|wss):/.test(text);
  if (plain && !text.startsWith("rr")) {
    const host = `${plain[1] ?? ""}:${plain[2] ?? (isSecure ? "443" : text.startsWith("http:") || text.startsWith("ws:") ? "80" : "48653")}`;
    return { kind: "node", host, url: `${isSecure ? "rr+wss" : "rr+ws"}://${host}/?service=${serviceIndex}` };
  }
  const scheme = /^(rrs?\+[a-z]+):/.exec(text)?.[1];
  const why = scheme === undefined ? undefined : foreign[scheme];
  if (why !== undefined) return { kind: "unusable", why };
  let url = text.replace(/^tcp:/, "rr+tcp:").replace(/^ws:/, "rr+ws:").replace(/^wss:/, "rr+wss:");
  const isTranslated = url.startsWith("rr+tcp:");
  if (isTranslated) {
    // Web sockets have another default port than TCP.
    const bare = /^rr\+tcp:\/\/(\[[^\]]*\]|[^/:?#]*)(?=$|[/?#])/.exec(url);
    url = bare ? url.replace(bare[0], `rr+ws://${bare[1] ?? ""}:48653`) : url.replace("rr+tcp:", "rr+ws:");
  }
  // As URLs were written in 2011: tcp://host:port/node/service.
  const old = /^rr\+(wss?):\/\/([^/?#]+)\/([^/?#]+)\/([^/?#]+)$/.exec(url);
  if (old) url = `rr+${old[1] ?? "ws"}://${old[2] ?? ""}/?nodename=${old[3] ?? ""}&service=${old[4] ?? ""}`;
  const bareNode = /^(rr\+wss?):\/\/(\[[^\]]*\]|[^/:?#]*)(:\d+)?\/?$/.exec(url);
  if (bareNode) {
    const host = `${bareNode[2] ?? ""}${bareNode[3] ?? ""}`;
    return { kind: "node", host, url: `${bareNode[1] ?? "rr+ws"}://${host}/?service=${serviceIndex}` };
  }
  try {
    const parsed = parseUrl(url);
    if (parsed.scheme !== "rr+ws" && parsed.scheme !== "rr+wss") return { kind: "unusable", why: `A page cannot use ${parsed.scheme}; it can use rr+ws and rr+wss.` };
  } catch (error) {
    return { kind: "unusable", why: error instanceof Error ? error.message : String(error) };
  }
  return { kind: "service", url, ...(isTranslated ? { note: "rr+tcp was replaced by rr+ws: nodes answer web sockets at the same port." } : {}) };
}

/** The URL of another service of the same node. */
export function serviceAt(url: string, service: string): string {
  return url.replace(/([?&]service=)[^&#]*/, (_, before: string) => `${before}${encodeURIComponent(service)}`);
}

/** Host and port of a URL, for titles. */
export function hostOf(url: string): string {
  try {
    const { host, port } = parseUrl(url);
    return `${host.includes(":") ? `[${host}]` : host}:${port}`;
  } catch {
    return url;
  }
}

/** Ports that browsers refuse to connect to, whatever answers there (Fetch standard, "port blocking"). */
const blockedPorts: ReadonlySet<number> = new Set([
  1, 7, 9, 11, 13, 15, 17, 19, 20, 21, 22, 23, 25, 37, 42, 43, 53, 69, 77, 79, 87, 95, 101, 102, 103, 104, 109, 110, 111, 113, 115, 117, 119, 123, 135, 137, 139,
  143, 161, 179, 389, 427, 465, 512, 513, 514, 515, 526, 530, 531, 532, 540, 548, 554, 556, 563, 587, 601, 636, 989, 990, 993, 995, 1719, 1720, 1723, 2049, 3659,
  4045, 4190, 5060, 5061, 6000, 6566, 6665, 6666, 6667, 6668, 6669, 6679, 6697, 10080,
]);

/** Where the page is, and what a look at the port gave. */
export interface Surroundings {
  /** `location.protocol` and `location.origin` of the page. */
  readonly protocol: string;
  readonly origin: string;
  /** Whether something answers HTTP at the port; undefined when it was not asked. */
  readonly answers: boolean | undefined;
}

const loopback = /^(?:localhost|127(?:\.\d+){3}|::1|.*\.localhost)$/;

/** Why a web socket did not open, as well as a page can know it, and what to do. */
export function explainFailure(url: string, message: string, { protocol, origin, answers }: Surroundings): { readonly why: string; readonly what: readonly string[] } {
  const { scheme, host, port } = parseUrl(url);
  const at = `${host}:${port}`;
  if (blockedPorts.has(port)) {
    return { why: `Browsers refuse to connect to port ${port}.`, what: ["Start the node at another port, for instance --robotraconteur-tcp-port=48653."] };
  }
  if (protocol === "https:" && scheme === "rr+ws" && !loopback.test(host)) {
    return {
      why: "Mixed content: this page came over https, so the browser allows encrypted connections only.",
      what: ["Use rr+wss, with a certificate that the browser trusts.", "Or open the inspector from a file, or from the node itself: http://" + at + "/"],
    };
  }
  if (!/no web socket at/.test(message)) return { why: message, what: [] };
  if (answers === true) {
    const isFile = origin === "null" || protocol === "file:";
    return {
      why: `Something answers at ${at}, but refuses this page. Nodes refuse pages of origins that they do not know; this page's origin is ${isFile ? "that of a local file" : origin}.`,
      what: [
        `Let the node serve the inspector: --robotraconteur-web-inspector, then open http://${at}/`,
        isFile ? "Or allow local files: --robotraconteur-tcp-ws-allow-local-pages" : `Or allow this origin: --robotraconteur-tcp-ws-add-origin=${origin}`,
        "Or the port belongs to another kind of server.",
      ],
    };
  }
  return {
    why: `Nothing answers at ${at}.`,
    what: [
      "Check that the node runs, and its port.",
      loopback.test(host)
        ? "The browser has to be on the machine of the node for this address."
        : "Nodes of robdef listen on their own machine only, unless started with --robotraconteur-tcp-listen-localhost=false. A firewall may be in between.",
      ...(scheme === "rr+wss" ? ["For rr+wss the browser has to trust the certificate: open https://" + at + "/ once to see its verdict."] : []),
    ],
  };
}
