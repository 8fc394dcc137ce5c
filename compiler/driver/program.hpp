// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// For tests: the built program, started as a user would.
namespace robdef {

struct Ended {
  int status = -1;  ///< exit status; -1 when it was ended by a signal
  std::string out;
  std::string err;
};

/// A folder of one test, removed at its end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string operator/(std::string_view name) const;
  /// Writes a file, its folders too; returns its path.
  std::string write(std::string_view name, std::string_view text) const;
  /// Paths of all regular files, relative, sorted.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& file);

/// Runs robdef in `folder`. `import_variable` becomes ROBOTRACONTEUR_ROBDEF_PATH, and `input` what
/// it reads.
Ended run_robdef(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
                 const std::string& import_variable = "", const std::string& input = "");

/// Robdef while it runs, until it ends or is asked to.
class Running {
 public:
  Running(const TemporaryFolder& folder, std::vector<std::string> arguments);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// The number behind the last blank of the first line, which names the port.
  [[nodiscard]] std::uint16_t port() const;
  /// Waits for its end, and asks for it if `signal` is not 0; its exit status, -1 when a signal has
  /// ended it.
  int end(int signal = SIGINT);
  [[nodiscard]] std::string out() const { return read_text(out_); }
  [[nodiscard]] std::string err() const { return read_text(err_); }

 private:
  const std::string out_;
  const std::string err_;
  pid_t process_ = -1;
};

}  // namespace robdef
