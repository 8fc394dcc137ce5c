// SPDX-License-Identifier: Apache-2.0
import { render } from "preact";
import { App, type Platform } from "./model/app.js";
import { AppView } from "./view/app_view.js";
import { currentTheme, setTheme } from "./view/theme.js";

function storage(): Storage | undefined {
  try {
    return localStorage;
  } catch {
    return undefined;
  }
}

const platform: Platform = {
  protocol: location.protocol,
  origin: location.origin,
  storage: storage(),
  answers: async (url) => {
    try {
      await fetch(url, { mode: "no-cors", cache: "no-store", credentials: "omit", signal: AbortSignal.timeout(2000) });
      return true;
    } catch {
      return false;
    }
  },
};

const app = new App(platform);
setTheme(currentTheme());
render(<AppView app={app} />, document.body);

async function begin(): Promise<void> {
  const layout = App.layoutIn(location.hash);
  if (layout.urls.length > 0) await app.restore(layout);
  // A node served the page: what it has is worth showing first.
  else if (location.protocol.startsWith("http")) await app.discover(location.host.includes(":") ? location.host : `${location.host}:${location.protocol === "https:" ? 443 : 80}`, location.protocol === "https:");
  app.keepLayout((hash) => {
    history.replaceState(null, "", hash === "" ? location.pathname + location.search : `#${hash}`);
  });
}

void begin();
