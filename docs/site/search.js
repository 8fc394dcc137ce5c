// SPDX-License-Identifier: Apache-2.0
// Searches the pages in the page itself, since a browser that shows files lets no script fetch others. Takes the place of
// mkdocs' own script; `pageIndex` and `lunr` come from script elements that it adds.
(function () {
  "use strict";
  const input = document.getElementById("mkdocs-search-query");
  const results = document.getElementById("mkdocs-search-results");
  if (!input || !results) return;

  function load(name, next) {
    const script = document.createElement("script");
    script.src = `${base_url}/search/${name}`;
    script.onload = next;
    document.head.append(script);
  }

  function element(name, text) {
    const made = document.createElement(name);
    made.textContent = text;
    return made;
  }

  function show(found, documents) {
    results.replaceChildren();
    if (!found.length) results.append(element("p", "No page has these words."));
    for (const { ref } of found.slice(0, 50)) {
      const page = documents.get(ref);
      const link = element("a", page.title);
      link.href = `${base_url}/${ref}`;
      const heading = element("h3", "");
      heading.append(link);
      const article = document.createElement("article");
      article.append(heading, element("p", page.text.slice(0, 200)));
      results.append(article);
    }
  }

  function start() {
    const documents = new Map(pageIndex.docs.map((page) => [page.location, page]));
    const index = lunr(function () {
      this.field("title", { boost: 5 });
      this.field("text");
      this.ref("location");
      pageIndex.docs.forEach((page) => this.add(page));
    });
    const search = () => {
      // What is a sign of lunr's language is a letter here.
      const words = input.value.replace(/[:*~^+-]/g, " ").trim();
      if (words.length < 3) results.replaceChildren();
      else show(index.search(words), documents);
    };
    input.addEventListener("keyup", search);
    const wanted = new URLSearchParams(window.location.search).get("q");
    if (wanted) {
      input.value = wanted;
      search();
    }
  }

  load("lunr.js", () => load("index.js", start));
})();
