// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/driver/options.hpp"

/// What the values of options do (OptionRow::take): each takes one into the options, and returns
/// what is wrong with it; empty when nothing is.
namespace robdef {

std::string take_language(Options& options, const std::string& value);
std::string take_format(Options& options, const std::string& value);
/// Several, separated by commas.
std::string take_languages(Options& options, const std::string& value);
std::string take_docs_form(Options& options, const std::string& value);
std::string take_breaking_form(Options& options, const std::string& value);
std::string take_categories(Options& options, const std::string& value);
std::string take_allowed(Options& options, const std::string& value);
std::string take_import_folder(Options& options, const std::string& value);
/// KEY=VALUE; of two with one key the later counts.
std::string take_plugin_option(Options& options, const std::string& value);
std::string take_rename(Options& options, const std::string& value);

template <Level level>
std::string take_level(Options& options, const std::string& value) {
  return options.levels.set(value, level);
}

template <std::string Options::*member>
std::string take_text(Options& options, const std::string& value) {
  options.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <bool Options::*member>
std::string take_switch(Options& options, const std::string&) {
  options.*member = true;
  return "";
}

}  // namespace robdef
