// SPDX-License-Identifier: Apache-2.0
// Reads definitions out of git by its plumbing commands, whose output does not depend on settings.
// Files are read by their hashes, so that no name of a file is an argument.
#include "compiler/driver/revision.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include "compiler/driver/child_process.hpp"
#include "compiler/driver/version_error.hpp"

namespace robdef {
namespace {

// As of files.
constexpr std::size_t largest_file = std::size_t{64} << 20U;
constexpr std::size_t largest_list = std::size_t{64} << 20U;

// What git says is wrong, without the word that it begins with.
std::string complaint_in(const std::string& err) {
  std::string line = err.substr(0, err.find('\n'));
  for (const std::string_view word : {"fatal: ", "error: "}) {
    if (line.starts_with(word)) line.erase(0, word.size());
  }
  return line.empty() ? "git gives no reason" : line;
}

std::string git(std::vector<std::string> words, std::size_t limit) {
  words.insert(words.begin(), {"git", "--no-pager"});
  ChildOutput output;
  try {
    output = run_child(words, limit);
  } catch (const std::system_error& error) {
    throw VersionError("git cannot be run: " + error.code().message());
  }
  if (output.is_cut) throw VersionError("git gives more than " + std::to_string(limit) + " bytes");
  if (output.status != 0) throw VersionError("git: " + complaint_in(output.err));
  return std::move(output.out);
}

std::string without_line_end(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

// `a/b/c.robdef`: `a/b`; `c.robdef`: nothing; `./c.robdef`: `./`, since git takes `.` for a name.
std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return "";
  const std::string folder = path.substr(0, slash);
  return folder.ends_with('.') ? folder + '/' : folder;
}

// A name with a line break could be a command to whatever reads the output, as a workflow does.
bool has_control_character(std::string_view name) {
  return std::any_of(name.begin(), name.end(), [](char letter) {
    return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7F;
  });
}

bool is_hidden(std::string_view path) {
  return path.starts_with('.') || path.find("/.") != std::string_view::npos;
}

// Up to the next one of `end`, which is taken off as well.
std::string_view take_until(std::string_view& text, char end) {
  const std::size_t size = std::min(text.find(end), text.size());
  const std::string_view word = text.substr(0, size);
  text.remove_prefix(std::min(size + 1, text.size()));
  return word;
}

}  // namespace

Revision::Revision(const std::string& written) {
  const std::size_t colon = written.find(':');
  const std::string revision = written.substr(0, colon);
  std::string path = written.substr(colon + 1);
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  if (revision.empty()) throw VersionError("there is no revision before the `:`");
  if (revision.starts_with('-')) throw VersionError("no revision begins with `-`");

  const std::string object = revision + ':' + path;
  const std::string type = without_line_end(git({"cat-file", "-t", object}, largest_list));
  if (type == "tree") {
    list(object, true);
    for (const auto& [name, blob] : blobs_) given_.push_back(name);
    if (given_.empty()) throw VersionError("there is no .robdef file in this folder");
  } else if (type == "blob") {
    list(revision + ':' + folder_of(path), false);
    // Of any name.
    const std::string hash = without_line_end(git({"rev-parse", "--verify", object}, largest_list));
    const std::string size = without_line_end(git({"cat-file", "-s", hash}, largest_list));
    blobs_[object] = {"100644", hash, size};
    given_.push_back(object);
  } else {
    throw VersionError("is a " + type + " of git, no file or folder");
  }
}

// `mode type hash    size<TAB>path<NUL>` for each file.
void Revision::list(const std::string& tree, bool with_folders_below) {
  std::vector<std::string> words = {"ls-tree", "-z", "-l", "--full-tree"};
  if (with_folders_below) words.emplace_back("-r");
  words.push_back(tree);
  const std::string all = git(std::move(words), largest_list);
  const std::string beginning = tree.ends_with(':') || tree.ends_with('/') ? tree : tree + '/';
  for (std::string_view rest = all; !rest.empty();) {
    std::string_view line = take_until(rest, '\0');
    std::string_view facts = take_until(line, '\t');
    const std::string mode(take_until(facts, ' '));
    const std::string_view type = take_until(facts, ' ');
    const std::string hash(take_until(facts, ' '));
    facts.remove_prefix(std::min(facts.find_first_not_of(' '), facts.size()));
    if (type != "blob" || !line.ends_with(".robdef") || is_hidden(line)) continue;
    if (has_control_character(line)) {
      throw VersionError("the name `" + std::string(line) + "` holds a control character");
    }
    blobs_[beginning + std::string(line)] = {mode, hash, std::string(facts)};
  }
}

std::string Revision::text_of(const std::string& name) const {
  const Blob& blob = blobs_.at(name);
  if (blob.mode == "120000") {
    throw VersionError("`" + name + "` is a symbolic link, which is not followed");
  }
  std::uint64_t size = 0;
  std::from_chars(blob.size.data(), blob.size.data() + blob.size.size(), size);
  if (size > largest_file) {
    static_assert(largest_file == std::size_t{64} << 20U);
    throw VersionError("`" + name + "` is larger than 64 MiB");
  }
  return git({"cat-file", "blob", blob.hash}, largest_file);
}

std::vector<ast::NamedText> Revision::definitions() const {
  std::vector<ast::NamedText> texts;
  for (const std::string& name : given_) texts.push_back({name, text_of(name), false});
  return texts;
}

std::optional<ast::NamedText> Revision::find_import(const std::string& service,
                                                    const std::string& importing,
                                                    const ast::SearchPath& path) const {
  const std::string file = service + ".robdef";
  const std::size_t end = importing.find_last_of(":/");
  const std::string beside = (end == std::string::npos ? "" : importing.substr(0, end + 1)) + file;
  if (blobs_.contains(beside)) return ast::NamedText{beside, text_of(beside), true};
  for (const std::string& folder : path.folders) {
    const std::string candidate = folder + '/' + file;
    ast::FileText read = ast::read_file(candidate);
    if (read.is_missing) continue;
    if (!read.text) throw VersionError("`" + candidate + "` " + read.failure);
    return ast::NamedText{candidate, *std::move(read.text), true};
  }
  return std::nullopt;
}

}  // namespace robdef
