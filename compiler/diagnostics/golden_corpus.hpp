// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace robdef {

/// A folder of inputs with their expected outputs beside them: `x.robdef` and `x.stderr`, `x.ast`,
/// or whatever suffix a test asks for. An output that is not there means "expect nothing".
/// With the environment variable ROBDEF_UPDATE set to a pattern (`*` and `?`) that fits the name of
/// an input, its outputs are rewritten instead of compared, and removed when they become empty.
class GoldenCorpus {
 public:
  /// `extension` is that of the inputs, with its dot.
  explicit GoldenCorpus(const std::filesystem::path& folder,
                        const std::string& extension = ".robdef");

  /// All inputs in the order of their names.
  [[nodiscard]] const std::vector<std::filesystem::path>& inputs() const { return inputs_; }

  /// Compares an output of an input with the file beside it whose name is that of the input with
  /// `suffix` (`.stderr`, or `.cpp/point.hpp` for one of several) instead of the extension.
  /// Empty when they are equal, else what differs, with the first line that does.
  [[nodiscard]] std::string difference(const std::filesystem::path& input, std::string_view suffix,
                                       std::string_view actual) const;

  /// The whole text of a file. Throws std::runtime_error when it cannot be read.
  static std::string read(const std::filesystem::path& file);

 private:
  std::vector<std::filesystem::path> inputs_;
};

/// What the first line of an example says about it:
/// `# expect: reject; rule: V12; with: base_types; stage: verify; ...`
struct Example {
  std::filesystem::path file;
  bool is_accepted = false;
  std::string rule;   ///< `V12`; `-` for none in particular
  std::string stage;  ///< of rejected ones: `parse`, `version`, `verify`; empty for helpers
  std::vector<std::filesystem::path> companions;  ///< examples to be loaded together with it
};

/// The examples of a folder whose first line begins with `# expect:`, in the order of their names.
/// Companions are looked for in the folder itself and in its siblings `accept` and `reject`.
/// Throws std::runtime_error for one that is not there.
std::vector<Example> read_examples(const std::filesystem::path& folder);

}  // namespace robdef
