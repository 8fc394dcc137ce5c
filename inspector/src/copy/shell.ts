// SPDX-License-Identifier: Apache-2.0
import type { Operation } from "../model/history.js";
import { placeText } from "../model/history.js";
import { jsonText } from "../model/value_text.js";

/** A word of a POSIX shell. */
function word(text: string): string {
  return /^[A-Za-z0-9_./:=@%+,-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

/** URLs of web sockets are used by programs, too. */
export function shellCode(operation: Operation): string {
  const { kind, url, steps, member, args, definitions, detail } = operation;
  const at = word(url);
  const place = word(placeText(steps, member?.name));
  const values = args.map(({ type, value }) => word(definitions ? jsonText(definitions, type, value) : "")).join(" ");
  const [start = "", count = ""] = (detail ?? "").split(" ");
  switch (kind) {
    case "connect":
      return `robdef describe ${at}`;
    case "login":
      return `robdef describe --user ${word(detail ?? "")} ${at}`;
    case "get":
    case "peek":
      return `robdef get ${at} ${place}`;
    case "set":
    case "poke":
      return `robdef set ${at} ${place} ${values}`;
    case "read":
      return `robdef get --at ${word(start)} --count ${word(count)} ${at} ${place}`;
    case "write":
      return `robdef set --at ${word(start)} ${at} ${place} ${values}`;
    case "call":
    case "generate":
      return `robdef call ${at} ${place}${values === "" ? "" : ` ${values}`}`;
    case "next":
      return `robdef call --count 1 ${at} ${place}`;
    case "watch":
      return member?.kind === "property" || member?.kind === "function" ? `robdef ${member.kind === "function" ? "call" : "get"} ${at} ${place}` : `robdef watch ${at} ${place}`;
    case "lock":
    case "unlock": {
      const object = placeText(steps);
      const words = kind === "lock" ? `lock ${detail === "user" ? "user" : "client"}` : "unlock";
      return `printf '%s\\n' ${object === "" ? "" : `${word(`cd ${object}`)} `}${word(words)} | robdef connect ${at}`;
    }
    default:
      return `# the command line has nothing for this: ${kind} ${placeText(steps, member?.name)}`;
  }
}
