// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { explainFailure, readAddress, serviceAt } from "../src/model/address.js";

describe("An address", () => {
  it("that a page can use is taken as it is", () => {
    const url = "rr+ws://host:6257/?service=camera&nodename=a.b";
    assert.deepEqual(readAddress(` ${url} `), { kind: "service", url });
    assert.deepEqual(readAddress("rr+wss://host/?service=camera"), { kind: "service", url: "rr+wss://host/?service=camera" });
  });

  it("of TCP becomes that of web sockets, with TCP's default port", () => {
    for (const [tcp, ws] of [
      ["rr+tcp://host:6257/?service=a", "rr+ws://host:6257/?service=a"],
      ["rr+tcp://host/?service=a", "rr+ws://host:48653/?service=a"],
      ["rr+tcp://[::1]/?service=a", "rr+ws://[::1]:48653/?service=a"],
      ["tcp://host:1/?service=a", "rr+ws://host:1/?service=a"],
      ["tcp://localhost:6257/RobotCameraHost/CameraHost", "rr+ws://localhost:6257/?nodename=RobotCameraHost&service=CameraHost"],
    ] as const) {
      const read = readAddress(tcp);
      assert.equal(read.kind === "service" && read.url, ws);
      assert.match(read.kind === "service" ? (read.note ?? "") : "", /replaced by rr\+ws/);
    }
  });

  it("without a service asks the node for its services", () => {
    const index = (url: string): unknown => ({ kind: "node", host: /\/\/([^/]*)/.exec(url)?.[1], url: `${url}/?service=RobotRaconteurServiceIndex` });
    assert.deepEqual(readAddress("host:6257"), index("rr+ws://host:6257"));
    assert.deepEqual(readAddress("host"), index("rr+ws://host:48653"));
    assert.deepEqual(readAddress("http://host:6257/"), index("rr+ws://host:6257"));
    assert.deepEqual(readAddress("https://host/"), index("rr+wss://host:443"));
    assert.deepEqual(readAddress("rr+ws://host:6257"), index("rr+ws://host:6257"));
    assert.deepEqual(readAddress("rr+tcp://host:6257/"), index("rr+ws://host:6257"));
  });

  it("that no page can use is refused with a reason", () => {
    for (const [url, why] of [
      ["rr+local:///?service=a", /machine/],
      ["rrs+tcp://host:1/?service=a", /rr\+wss/],
      ["rr+serial:///dev/ttyACM0", /bridge/],
      ["", /Enter/],
      ["what is this", /no URL/],
      ["rr+quic://host:1/?service=a", /does not have/],
    ] as const) {
      const read = readAddress(url);
      assert.match(read.kind === "unusable" ? read.why : `usable: ${url}`, why);
    }
  });

  it("of another service of the same node keeps the rest", () => {
    assert.equal(serviceAt("rr+ws://h:1/?nodename=n&service=a", "b c"), "rr+ws://h:1/?nodename=n&service=b%20c");
  });
});

describe("A failure is explained", () => {
  const message = "no web socket at h:1";
  const explain = (url: string, protocol: string, origin: string, answers: boolean | undefined): string => {
    const { why, what } = explainFailure(url, message, { protocol, origin, answers });
    return [why, ...what].join(" ");
  };

  it("as mixed content where the page is of https", () => {
    assert.match(explain("rr+ws://robot:1234/?service=a", "https:", "https://a", false), /Mixed content/);
    // Browsers let pages of https use the machine itself.
    assert.doesNotMatch(explain("rr+ws://localhost:1234/?service=a", "https:", "https://a", false), /Mixed content/);
  });

  it("as a port that browsers block", () => {
    assert.match(explain("rr+ws://robot:6000/?service=a", "http:", "http://a", false), /port 6000/);
  });

  it("as an origin that is refused where something answers", () => {
    assert.match(explain("rr+ws://robot:1234/?service=a", "http:", "http://a:1", true), /ws-add-origin=http:\/\/a:1/);
    assert.match(explain("rr+ws://robot:1234/?service=a", "file:", "null", true), /allow-local-pages/);
  });

  it("as nothing there where nothing answers", () => {
    assert.match(explain("rr+ws://robot:1234/?service=a", "http:", "http://a", false), /Nothing answers at robot:1234/);
  });
});
