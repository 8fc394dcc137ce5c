// SPDX-License-Identifier: Apache-2.0
// URLs that were connected, newest first; kept by the browser.

const key = "robdef.inspector.recent";
const most = 12;

type Storage = Pick<globalThis.Storage, "getItem" | "setItem">;

/** Empty where the browser keeps nothing, as for files in some browsers. */
export function recentUrls(storage: Storage | undefined): string[] {
  try {
    const found: unknown = JSON.parse(storage?.getItem(key) ?? "[]");
    return Array.isArray(found) ? found.filter((one): one is string => typeof one === "string" && one.length <= 2000).slice(0, most) : [];
  } catch {
    return [];
  }
}

export function rememberUrl(storage: Storage | undefined, url: string): string[] {
  return keep(storage, [url, ...recentUrls(storage).filter((one) => one !== url)].slice(0, most));
}

export function forgetUrl(storage: Storage | undefined, url: string): string[] {
  return keep(storage, recentUrls(storage).filter((one) => one !== url));
}

function keep(storage: Storage | undefined, urls: string[]): string[] {
  try {
    storage?.setItem(key, JSON.stringify(urls));
  } catch {
    // A full or forbidden storage: the list is that of this page only.
  }
  return urls;
}
