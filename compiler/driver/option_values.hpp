// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
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
std::string take_entry_types(Options& options, const std::string& value);
std::string take_connection(Options& options, const std::string& value);
std::string take_port(Options& options, const std::string& value);
std::string take_discover_format(Options& options, const std::string& value);
std::string take_discovery_port(Options& options, const std::string& value);
std::string take_wait(Options& options, const std::string& value);
std::string take_interface(Options& options, const std::string& value);
/// From 1 to 36500.
std::string take_number_of_days(std::optional<int>& days, const std::string& value);

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

template <bool RecordingOptions::*member>
std::string take_recording_switch(Options& options, const std::string&) {
  options.recording.*member = true;
  return "";
}

template <std::string RecordingOptions::*member>
std::string take_recording_text(Options& options, const std::string& value) {
  options.recording.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <std::string AuthorityOptions::*member>
std::string take_authority_text(Options& options, const std::string& value) {
  options.authority.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <bool AuthorityOptions::*member>
std::string take_authority_switch(Options& options, const std::string&) {
  options.authority.*member = true;
  return "";
}

template <std::optional<int> AuthorityOptions::*member>
std::string take_days(Options& options, const std::string& value) {
  return take_number_of_days(options.authority.*member, value);
}

}  // namespace robdef
