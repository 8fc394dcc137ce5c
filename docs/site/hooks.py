# SPDX-License-Identifier: Apache-2.0
"""For mkdocs: only pages and pictures are part of the site, links to other files become their paths, and the search works
without a server."""
import os
import re
import shutil

SITE = os.path.dirname(os.path.abspath(__file__))

LINK = re.compile(r"\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")


def on_page_markdown(markdown, page, config, files):
    here = os.path.dirname(page.file.src_path)

    def replace(match):
        text, target = match.groups()
        path = target.partition("#")[0]
        if re.match(r"[a-z][a-z0-9+.-]*:", target) or not path:
            return match.group(0)
        full = os.path.normpath(os.path.join(here, path))
        if files.get_file_from_path(full):
            return match.group(0)
        root = os.path.normpath(os.path.join("docs", full))  # from the top of the sources
        return text if root.strip("/") in text.replace("`", "") else f"{text} (`{root}` in the sources)"

    # Python's Markdown takes a line that follows a comment for a part of it.
    return re.sub(r"(?m)^<!--.*?-->\n", "", LINK.sub(replace, markdown))


def on_files(files, config):
    for file in list(files):
        is_ours = file.abs_src_path.startswith(config["docs_dir"])
        if is_ours and not file.src_path.endswith((".md", ".svg", ".png", ".css")):
            files.remove(file)
    return files


def on_post_build(config):
    search = os.path.join(config["site_dir"], "search")
    with open(os.path.join(search, "search_index.json"), encoding="utf-8") as file:
        index = file.read()
    with open(os.path.join(search, "index.js"), "w", encoding="utf-8") as file:
        file.write(f"const pageIndex = {index};\n")
    shutil.copy(os.path.join(SITE, "search.js"), os.path.join(search, "main.js"))
    os.remove(os.path.join(search, "worker.js"))
    os.remove(os.path.join(search, "search_index.json"))
