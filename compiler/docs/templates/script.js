// The search box. Texts of definitions reach the page by textContent only.
(function () {
  "use strict";
  var own = document.getElementById("_own");
  var pages = window.robdefPages || (own ? [JSON.parse(own.textContent)] : []);
  var search = document.getElementById("_search");
  var box = document.getElementById("_box");
  var list = document.getElementById("_results");
  var count = document.getElementById("_count");
  var most = 40;
  var selected = -1;

  if (window.matchMedia("(max-width: 50rem)").matches) {
    document.querySelectorAll(".contents details").forEach(function (part) { part.open = false; });
  }
  if (pages.length === 0) return;
  search.hidden = false;

  var entries = [];
  pages.forEach(function (page) {
    page.entries.forEach(function (entry) {
      entries.push({
        kind: entry[0], name: entry[1], words: entry[3], definition: page.name,
        address: page.page + (entry[2] ? "#" + entry[2] : ""),
        lowerName: entry[1].toLowerCase(),
        last: entry[1].toLowerCase().replace(/^.*\./, ""),
        lowerDefinition: page.name.toLowerCase(),
        lowerWords: entry[3].toLowerCase()
      });
    });
  });

  // Smaller is better; nothing where a word is not found at all.
  function rankOf(entry, word) {
    if (entry.last === word || entry.lowerName === word) return 0;
    if (entry.last.indexOf(word) === 0) return 1;
    if (entry.lowerName.indexOf(word) === 0) return 2;
    if (entry.lowerName.indexOf(word) > 0) return 3;
    if ((entry.lowerDefinition + "." + entry.lowerName).indexOf(word) >= 0) return 4;
    return entry.lowerWords.indexOf(word) >= 0 ? 5 : -1;
  }

  function find(text) {
    var words = text.toLowerCase().split(/\s+/).filter(Boolean);
    var found = [];
    if (words.length === 0) return found;
    entries.forEach(function (entry) {
      var rank = 0;
      var isFound = words.every(function (word) {
        var one = rankOf(entry, word);
        rank += one;
        return one >= 0;
      });
      if (isFound) found.push({ rank: rank, entry: entry });
    });
    found.sort(function (a, b) {
      return a.rank - b.rank || a.entry.name.length - b.entry.name.length;
    });
    return found.map(function (one) { return one.entry; });
  }

  // The documentation around the first word that is found in it.
  function excerpt(entry, text) {
    var word = text.toLowerCase().split(/\s+/).filter(Boolean)[0] || "";
    var at = Math.max(0, entry.lowerWords.indexOf(word));
    var begin = at < 60 ? 0 : entry.words.indexOf(" ", at - 50) + 1;
    var end = begin + 120;
    return (begin > 0 ? "\u2026 " : "") + entry.words.slice(begin, end) +
      (end < entry.words.length ? " \u2026" : "");
  }

  function part(name, text) {
    var element = document.createElement("span");
    element.className = name;
    element.textContent = text;
    return element;
  }

  function show(text) {
    var found = find(text);
    list.textContent = "";
    found.slice(0, most).forEach(function (entry, at) {
      var item = document.createElement("li");
      item.id = "_result" + at;
      item.setAttribute("role", "option");
      item.setAttribute("aria-selected", "false");
      item.dataset.address = entry.address;
      item.appendChild(part("found", entry.name));
      var where = entry.kind === "definition" ? entry.kind : entry.kind + " in " + entry.definition;
      item.appendChild(part("where", where));
      if (entry.words) item.appendChild(part("words", excerpt(entry, text)));
      list.appendChild(item);
    });
    var isAsked = text.trim() !== "";
    if (isAsked && found.length === 0) {
      var none = document.createElement("li");
      none.className = "empty";
      none.setAttribute("role", "option");
      none.setAttribute("aria-disabled", "true");
      none.textContent = "Nothing is found.";
      list.appendChild(none);
    }
    count.textContent = !isAsked ? "" : found.length === 1 ? "1 result" : found.length + " results";
    open(isAsked);
    select(found.length > 0 ? 0 : -1);
  }

  function open(isOpen) {
    list.hidden = !isOpen;
    box.setAttribute("aria-expanded", String(isOpen));
  }

  function select(at) {
    var items = list.querySelectorAll("[data-address]");
    if (items[selected]) items[selected].setAttribute("aria-selected", "false");
    selected = at;
    box.removeAttribute("aria-activedescendant");
    if (!items[at]) return;
    items[at].setAttribute("aria-selected", "true");
    items[at].scrollIntoView({ block: "nearest" });
    box.setAttribute("aria-activedescendant", items[at].id);
  }

  function go(item) {
    if (!item) return;
    open(false);
    box.blur();
    window.location.href = item.dataset.address;
  }

  box.addEventListener("input", function () { show(box.value); });
  box.addEventListener("focus", function () { if (box.value) show(box.value); });
  box.addEventListener("blur", function () { open(false); });
  box.addEventListener("keydown", function (event) {
    var items = list.querySelectorAll("[data-address]");
    if (event.key === "Escape") {
      open(false);
      return;
    }
    if (list.hidden || items.length === 0) return;
    if (event.key === "ArrowDown") select((selected + 1) % items.length);
    else if (event.key === "ArrowUp") select((selected + items.length - 1) % items.length);
    else if (event.key === "Enter") go(items[selected]);
    else return;
    event.preventDefault();
  });
  // Before the box loses the focus, which would close the list.
  list.addEventListener("mousedown", function (event) {
    event.preventDefault();
    go(event.target.closest("[data-address]"));
  });
  document.addEventListener("keydown", function (event) {
    var isTyping = /^(input|textarea|select)$/i.test(event.target.tagName || "");
    if (event.key !== "/" || isTyping || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    box.focus();
    box.select();
  });
})();
