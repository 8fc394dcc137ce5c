// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/driver/options.hpp"

/// What the values of options do (OptionRow::take): each takes one into the options, and returns
/// what is wrong with it; empty when nothing is.
namespace robdef {

std::string take_language(Options& options, const std::string& value);
std::string take_format(Options& options, const std::string& value);
std::string take_silenced(Options& options, const std::string& value);
std::string take_import_folder(Options& options, const std::string& value);
std::string take_entry_types(Options& options, const std::string& value);
std::string take_connection(Options& options, const std::string& value);
std::string take_port(Options& options, const std::string& value);
std::string take_discover_format(Options& options, const std::string& value);
std::string take_discovery_port(Options& options, const std::string& value);
std::string take_wait(Options& options, const std::string& value);
std::string take_interface(Options& options, const std::string& value);
std::string take_days(Options& options, const std::string& value);

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

}  // namespace robdef
