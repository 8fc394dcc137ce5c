// SPDX-License-Identifier: Apache-2.0
// Web sockets in a worker. Thousands of messages a second are thousands of events, each of which costs the thread of
// the page more than the message itself; the worker hands them over together, a few hundred times a second.
import {
  ErrorCode,
  openWebSocket,
  PushedStream,
  RRError,
  webSocketAddress,
  webSocketProtocol,
  type ByteStream,
  type OpenOptions,
  type ServiceUrl,
} from "@robdef/runtime";

/** What is run in the worker; it stands on nothing but its own words. */
function work(scope: { onmessage: ((event: MessageEvent) => void) | null; postMessage: (message: unknown, transfer?: Transferable[]) => void }): void {
  const period = 4;
  const large = 64 * 1024;
  let socket: WebSocket | undefined;
  let parts: Uint8Array[] = [];
  let size = 0;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let last = 0;
  let polling: ReturnType<typeof setInterval> | undefined;

  const flush = (): void => {
    clearTimeout(timer);
    timer = undefined;
    last = performance.now();
    if (size === 0) return;
    let whole = parts[0];
    if (parts.length > 1 || !whole) {
      whole = new Uint8Array(size);
      let at = 0;
      for (const part of parts) {
        whole.set(part, at);
        at += part.length;
      }
    }
    parts = [];
    size = 0;
    scope.postMessage({ data: whole }, [whole.buffer]);
  };
  const poll = (): void => {
    const waiting = socket?.bufferedAmount ?? 0;
    scope.postMessage({ waiting });
    if (waiting > 0) return;
    clearInterval(polling);
    polling = undefined;
  };
  scope.onmessage = ({ data }: MessageEvent<{ url?: string; protocol?: string; send?: Uint8Array<ArrayBuffer>[]; close?: boolean }>) => {
    if (data.url !== undefined) {
      socket = new WebSocket(data.url, data.protocol);
      socket.binaryType = "arraybuffer";
      socket.onopen = () => {
        scope.postMessage({ opened: true });
      };
      socket.onclose = () => {
        flush();
        scope.postMessage({ closed: true });
      };
      socket.onmessage = ({ data: bytes }: MessageEvent<unknown>) => {
        if (!(bytes instanceof ArrayBuffer)) {
          socket?.close();
          return;
        }
        const part = new Uint8Array(bytes);
        // Large ones go alone: they need no copy then.
        if (part.length >= large) flush();
        parts.push(part);
        size += part.length;
        if (part.length >= large || performance.now() - last >= period) flush();
        else timer ??= setTimeout(flush, period);
      };
    }
    for (const part of data.send ?? []) if (socket?.readyState === 1) socket.send(part);
    if (data.send) polling ??= setInterval(poll, period);
    if (data.close === true) socket?.close();
  };
}

type FromWorker = { readonly data: Uint8Array } | { readonly waiting: number } | { readonly opened: true } | { readonly closed: true };

let workerUrl: string | undefined;

function makeWorker(): Worker {
  workerUrl ??= URL.createObjectURL(new Blob([`(${work.toString()})(self)`], { type: "text/javascript" }));
  return new Worker(workerUrl);
}

/** As openWebSocket, with the socket in a worker; without workers as that. */
export function openWorkerSocket(url: ServiceUrl, options: OpenOptions): Promise<ByteStream> {
  let worker: Worker;
  try {
    worker = makeWorker();
  } catch {
    return openWebSocket(url, options);
  }
  const { signal } = options;
  return new Promise((resolve, reject) => {
    const fail = (reason: unknown): void => {
      signal.removeEventListener("abort", abort);
      worker.terminate();
      reject(reason);
    };
    const abort = (): void => {
      fail(signal.reason);
    };
    if (signal.aborted) {
      abort();
      return;
    }
    signal.addEventListener("abort", abort, { once: true });
    worker.onerror = (event) => {
      event.preventDefault();
      fail(new Error("the worker of a web socket failed"));
    };
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      if ("opened" in data) {
        signal.removeEventListener("abort", abort);
        resolve(new WorkerStream(worker, `${url.host}:${url.port}`));
      } else if ("closed" in data) {
        // The words are those that explanations of failures know.
        fail(new RRError(ErrorCode.ConnectionError, `no web socket at ${url.host}:${url.port}`));
      }
    };
    worker.postMessage({ url: webSocketAddress(url), protocol: webSocketProtocol });
  });
}

class WorkerStream extends PushedStream {
  private unsent = 0;

  constructor(
    private readonly worker: Worker,
    remoteAddress: string,
  ) {
    super(remoteAddress);
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      if ("data" in data) {
        this.push(data.data);
      } else if ("waiting" in data) {
        this.unsent = data.waiting;
        if (data.waiting === 0) this.drained();
      } else if ("closed" in data) this.end(undefined);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.end(new Error("the worker of a web socket failed"));
    };
  }

  get waiting(): number {
    return this.unsent;
  }

  send(pieces: readonly Uint8Array[]): void {
    if (this.isClosed) return;
    // Pieces may be views of what their owner changes afterwards: copies travel.
    const copies = pieces.map((piece) => piece.slice());
    for (const { length } of copies) this.unsent += length;
    this.worker.postMessage({ send: copies }, copies.map((copy) => copy.buffer));
  }

  protected release(): void {
    this.worker.postMessage({ close: true });
    // What was sent before is on its way; then the worker is no longer needed.
    setTimeout(() => {
      this.worker.terminate();
    }, 1000);
  }
}
