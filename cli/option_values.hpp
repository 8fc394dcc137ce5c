// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "cli/options.hpp"
#include "compiler/driver/option_values.hpp"

/// What the values of options of this folder's commands do.
namespace robdef {

std::string take_entry_types(Options& options, const std::string& value);
std::string take_connection(Options& options, const std::string& value);
std::string take_tolerance(Options& options, const std::string& value);
std::string take_port(Options& options, const std::string& value);
std::string take_discover_format(Options& options, const std::string& value);
std::string take_discovery_port(Options& options, const std::string& value);
std::string take_wait(Options& options, const std::string& value);
std::string take_interface(Options& options, const std::string& value);
/// From 1 to 36500.
std::string take_number_of_days(std::optional<int>& days, const std::string& value);

template <bool RecordingOptions::*member>
std::string take_recording_switch(Options& options, const std::string&) {
  more(options).recording.*member = true;
  return "";
}

template <std::string RecordingOptions::*member>
std::string take_recording_text(Options& options, const std::string& value) {
  more(options).recording.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <std::string AuthorityOptions::*member>
std::string take_authority_text(Options& options, const std::string& value) {
  more(options).authority.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <bool AuthorityOptions::*member>
std::string take_authority_switch(Options& options, const std::string&) {
  more(options).authority.*member = true;
  return "";
}

template <std::optional<int> AuthorityOptions::*member>
std::string take_days(Options& options, const std::string& value) {
  return take_number_of_days(more(options).authority.*member, value);
}

}  // namespace robdef
