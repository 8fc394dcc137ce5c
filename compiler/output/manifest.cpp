// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/manifest.hpp"

#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

namespace robdef {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view version_line = "version 1";
constexpr std::size_t hash_digits = 16;

/// FNV-1a. Tells edits, not attacks: whoever can write the manifest can write the file.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return hash;
}

std::string digits_of(std::uint64_t hash) {
  char digits[hash_digits + 1];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

std::optional<std::string> text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

bool leads_out(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return normal.empty() || normal.is_absolute() || *normal.begin() == ".." ||
         !normal.has_filename() || normal != path;
}

}  // namespace

std::string Manifest::file_name(std::string_view language) {
  return ".robdef-" + std::string(language) + ".manifest";
}

Manifest::Manifest(const FileSet& files) {
  for (const auto& [path, content] : files.files()) {
    if (!files.is_draft(path)) hashes_.emplace(path, hash_of(content));
  }
}

Manifest Manifest::read(const fs::path& file) {
  Manifest manifest;
  std::ifstream in(file, std::ios::binary);
  bool is_known = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    if (!is_known) {
      if (line != version_line) return manifest;
      is_known = true;
      continue;
    }
    if (line.size() <= hash_digits + 1 || line[hash_digits] != ' ') continue;
    std::uint64_t hash = 0;
    const char* const end = line.data() + hash_digits;
    const auto number = std::from_chars(line.data(), end, hash, 16);
    const std::string path = line.substr(hash_digits + 1);
    if (number.ec != std::errc() || number.ptr != end || leads_out(path)) continue;
    manifest.hashes_.emplace(path, hash);
  }
  return manifest;
}

std::string Manifest::text(std::string_view language) const {
  std::string text = "# What `robdef generate` has made here for " + std::string(language) +
                     ", so that it can remove what it no longer makes.\n" +
                     std::string(version_line) + "\n";
  for (const auto& [path, hash] : hashes_) text += digits_of(hash) + " " + path + "\n";
  return text;
}

std::vector<std::string> Manifest::stale(
    const Manifest& before, const std::function<bool(const std::string&)>& is_made) const {
  std::vector<std::string> paths;
  for (const auto& [path, hash] : before.hashes_) {
    if (!contains(path) && !is_made(path)) paths.push_back(path);
  }
  return paths;
}

void Manifest::keep(const std::string& path, const Manifest& before) {
  hashes_.emplace(path, before.hashes_.at(path));
}

bool Manifest::is_unedited(const fs::path& folder, const std::string& path) const {
  std::error_code error;
  const fs::path file = folder / path;
  if (fs::symlink_status(file, error).type() != fs::file_type::regular) return false;
  const fs::path inside = fs::canonical(file, error).lexically_relative(fs::canonical(folder));
  if (error || inside != fs::path(path)) return false;
  const std::optional<std::string> text = text_of(file);
  return text && hash_of(*text) == hashes_.at(path);
}

bool remove_output(const fs::path& folder, const std::string& path) {
  std::error_code error;
  fs::remove(folder / path, error);
  if (error) return false;
  for (fs::path inner = fs::path(path).parent_path(); !inner.empty(); inner = inner.parent_path()) {
    // Fails for a folder with anything in it.
    if (!fs::remove(folder / inner, error)) break;
  }
  return true;
}

}  // namespace robdef
