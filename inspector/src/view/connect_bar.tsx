// SPDX-License-Identifier: Apache-2.0
// Where to connect to, what happened, and what was connected before.
import type { VNode } from "preact";
import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import type { App } from "../model/app.js";
import type { Device } from "../model/device.js";
import { errorText } from "../model/errors.js";
import { shortName } from "../model/types.js";

export function ConnectBar({ app }: { app: App }): VNode {
  const url = useSignal("");
  const isConnecting = app.connecting.value !== "";
  const connect = (event: Event): void => {
    event.preventDefault();
    void app.connect(url.value);
  };
  return (
    <form class="connect" onSubmit={connect} aria-label="Connect to a service">
      <label for="address" class="visually-hidden">
        URL of a service, or host:port of a node
      </label>
      <input
        id="address"
        type="text"
        list="recent"
        value={url.value}
        placeholder="rr+ws://host:port/?service=name, or host:port"
        autocomplete="off"
        spellcheck={false}
        onInput={(event) => {
          url.value = event.currentTarget.value;
        }}
      />
      <datalist id="recent">
        {app.recent.value.map((one) => (
          <option key={one} value={one} />
        ))}
      </datalist>
      <button type="submit" class="primary" disabled={isConnecting}>
        {isConnecting ? "Connecting…" : "Connect"}
      </button>
    </form>
  );
}

/** Why connecting failed, with what can be done. */
export function Failure({ app }: { app: App }): VNode | null {
  const failure = app.failure.value;
  if (!failure) return null;
  return (
    <section class="card failure" role="alert" aria-label="Cannot connect">
      <h2>{failure.needsLogin ? "Log in to connect" : "Cannot connect"}</h2>
      <p class="url">{failure.url}</p>
      <p class="why">{failure.why}</p>
      {failure.what.length === 0 ? null : (
        <ul>
          {failure.what.map((one) => (
            <li key={one}>{one}</li>
          ))}
        </ul>
      )}
      {failure.needsLogin ? <LoginForm title="Connect as" onLogin={async (user, password) => { await app.connect(failure.url, { user, password }); }} /> : null}
      <div class="actions">
        <button type="button" onClick={() => { void app.connect(failure.url); }}>Try again</button>
        <button type="button" onClick={() => { app.failure.value = undefined; }}>Close</button>
      </div>
    </section>
  );
}

export function LoginForm({ title, onLogin }: { title: string; onLogin: (user: string, password: string) => Promise<void> }): VNode {
  const problem = useSignal("");
  const form = useRef<HTMLFormElement>(null);
  const submit = (event: Event): void => {
    event.preventDefault();
    if (!form.current) return;
    const fields = new FormData(form.current);
    const user = fields.get("user");
    const password = fields.get("password");
    onLogin(typeof user === "string" ? user : "", typeof password === "string" ? password : "").then(
      () => {
        problem.value = "";
        form.current?.reset();
      },
      (error: unknown) => {
        problem.value = errorText(error);
      },
    );
  };
  return (
    <form ref={form} class="login" onSubmit={submit} aria-label={title}>
      <label>
        User <input name="user" type="text" autocomplete="username" required />
      </label>
      <label>
        Password <input name="password" type="password" autocomplete="current-password" />
      </label>
      <button type="submit" class="primary">{title}</button>
      {problem.value === "" ? null : <p class="problem" role="alert">{problem.value}</p>}
    </form>
  );
}

/** What there is when nothing is connected. */
export function Welcome({ app }: { app: App }): VNode {
  const services = app.services.value;
  const recent = app.recent.value;
  return (
    <div class="welcome">
      {services ? (
        <section class="card" aria-label="Services of the node">
          <h2>
            Services of {services.nodeName === "" ? services.host : services.nodeName} <span class="type">{services.host}</span>
          </h2>
          {services.services.length === 0 ? <p class="empty">This node has no services.</p> : null}
          <ul class="links">
            {services.services.map((one) => (
              <li key={one.name}>
                <button type="button" class="link" onClick={() => { void app.connect(one.url); }}>{one.name}</button> <span class="type">{shortName(one.rootType)}</span>
              </li>
            ))}
          </ul>
          {services.others.length === 0 ? null : (
            <>
              <h3>Other nodes that it has found</h3>
              <ul class="links">
                {services.others.map((one) => (
                  <li key={one.url}>
                    <button type="button" class="link" onClick={() => { void app.connect(one.url.replace(/\/?\?.*$/, "")); }}>{one.name === "" ? one.url : one.name}</button>
                  </li>
                ))}
              </ul>
            </>
          )}
        </section>
      ) : null}
      <section class="card" aria-label="Begin">
        <h2>Look at a device</h2>
        <p>
          Enter the URL of a Robot Raconteur service above, such as <code>rr+ws://localhost:48653/?service=camera</code>, or <code>host:port</code> to see all services of a node. URLs with <code>rr+tcp</code>{" "}
          work, too: nodes answer web sockets at the same port.
        </p>
        <p>Or drop a recording (<code>.rrtape</code>) anywhere on this page.</p>
      </section>
      <section class="card" aria-label="Recent connections">
        <h2>Recent</h2>
        {recent.length === 0 ? (
          <p class="empty">Nothing was connected from this browser yet.</p>
        ) : (
          <ul class="links">
            {recent.map((one) => (
              <li key={one}>
                <button type="button" class="link" onClick={() => { void app.connect(one); }}>{one}</button>
                <button type="button" class="small quiet" aria-label={`Forget ${one}`} onClick={() => { app.forget(one); }}>Forget</button>
              </li>
            ))}
          </ul>
        )}
      </section>
    </div>
  );
}

/** State of a connection, user, and what ends it. */
export function DeviceHead({ app, device }: { app: App; device: Device }): VNode {
  const isOpen = device.state.value === "open";
  const showsLogin = useSignal(false);
  return (
    <div class="device-head">
      <span class={`state ${device.state.value}`}>{stateWords[device.state.value]}</span>
      <span class="url">{device.url}</span>
      {isOpen && device.user.value !== "" ? (
        <>
          <span>
            as <b>{device.user.value}</b>
          </span>
          <button type="button" class="small" onClick={() => { device.logout().catch((error: unknown) => { app.notice.value = errorText(error); }); }}>Log out</button>
        </>
      ) : null}
      {isOpen && device.user.value === "" ? (
        <button type="button" class="small" aria-expanded={showsLogin.value} onClick={() => { showsLogin.value = !showsLogin.value; }}>Log in…</button>
      ) : null}
      {isOpen ? null : <button type="button" class="small" onClick={() => { void app.reconnect(device); }}>Connect again</button>}
      <button type="button" class="small" onClick={() => { void app.disconnect(device); }}>Disconnect</button>
      {device.ending.value === "" ? null : <p class="problem" role="alert">{device.ending.value}</p>}
      {showsLogin.value && isOpen && device.user.value === "" ? (
        <LoginForm title="Log in" onLogin={async (user, password) => { await device.login(user, password); showsLogin.value = false; }} />
      ) : null}
    </div>
  );
}

const stateWords = { connecting: "connecting", open: "connected", lost: "lost", closed: "closed" } as const;
