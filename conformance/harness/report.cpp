// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/report.hpp"

#include <algorithm>
#include <iomanip>
#include <map>
#include <ostream>
#include <set>
#include <sstream>

namespace rr::conformance {
namespace {

constexpr Role roles[] = {Role::decode, Role::encode, Role::service, Role::client};

std::string counted(std::size_t number, const std::string& thing) {
  return std::to_string(number) + " " + thing + (number == 1 ? "" : "s");
}

}  // namespace

Report::Report(std::string language, const ExpectedFailures& expected, const Deviations& deviations,
               bool complete)
    : language_(std::move(language)),
      expected_(expected),
      deviations_(deviations),
      complete_(complete) {}

void Report::add(Result result) {
  Cell cell;
  const Run& run = result.run;
  if (const ListEntry* all = expected_.find(run, whole_run)) {
    if (result.faults.empty()) {
      cell.faults.push_back(
          {std::string(whole_run), "", all->where_listed() + ": passes, though it is listed"});
    } else {
      cell.not_supported = all;
    }
  } else {
    std::set<const ListEntry*> met;
    for (const Fault& fault : result.faults) {
      const ListEntry* entry = expected_.find(run, fault.place);
      if (entry == nullptr) {
        cell.faults.push_back(fault);
      } else if (met.insert(entry).second) {
        cell.expected.push_back(entry);
      }
    }
    for (const ListEntry& entry : expected_.entries()) {
      if (entry.covers(run) && !met.contains(&entry)) {
        entry.met = true;
        cell.faults.push_back(
            {entry.place(), "", entry.where_listed() + ": passes, though it is listed"});
      }
    }
  }
  cell.result = std::move(result);
  cells_.push_back(std::move(cell));
}

std::vector<std::string> Report::stale_entries() const {
  std::vector<std::string> stale;
  if (!complete_) return stale;
  const auto add_unmet = [&](const std::vector<ListEntry>& entries) {
    for (const ListEntry& entry : entries) {
      const bool was_played = std::ranges::any_of(
          cells_, [&](const Cell& cell) { return entry.is_of_channel(cell.result.run.channel); });
      if (!entry.met && was_played)
        stale.push_back(entry.where_listed() + ": nothing that was played is meant");
    }
  };
  add_unmet(expected_.entries());
  if (!deviations_.are_borrowed()) add_unmet(deviations_.entries());
  return stale;
}

bool Report::holds() const {
  const bool nothing_played = std::none_of(
      cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.result.checked > 0; });
  return !nothing_played && stale_entries().empty() &&
         std::all_of(cells_.begin(), cells_.end(),
                     [](const Cell& cell) { return cell.faults.empty(); });
}

std::string Report::outcome(const Cell& cell) {
  if (!cell.faults.empty()) return "FAIL";
  if (cell.not_supported != nullptr) return "not yet";
  if (!cell.expected.empty()) return "pass -" + std::to_string(cell.expected.size());
  return "pass";
}

void Report::print_matrix(std::ostream& out) const {
  // Channel, scenario, version; the channels as they were played.
  std::vector<std::string> channels;
  std::map<std::string, std::map<std::pair<std::string, std::string>, std::map<Role, std::string>>>
      tables;
  std::size_t width = 8;
  for (const Cell& cell : cells_) {
    const Run& run = cell.result.run;
    if (!tables.contains(run.channel)) channels.push_back(run.channel);
    tables[run.channel][{run.scenario, run.version}][run.role] = outcome(cell);
    width = std::max(width, run.scenario.size());
  }
  const auto column = [&](const std::string& text, std::size_t size) {
    out << std::left << std::setw(static_cast<int>(size)) << text << "  ";
  };
  column(language_, width);
  column("", 4);
  column("channel", 7);
  for (const Role role : roles) column(std::string(name_of(role)), 8);
  out << "\n";
  for (const std::string& channel : channels) {
    for (const auto& [row, outcomes] : tables[channel]) {
      column(row.first, width);
      column(row.second, 4);
      column(channel, 7);
      for (const Role role : roles) {
        const auto found = outcomes.find(role);
        column(found == outcomes.end() ? "." : found->second, 8);
      }
      out << "\n";
    }
  }
  out << "\n`.` is not played in this role; `-n`: n steps are expected to fail.\n";
}

void Report::print(std::ostream& out) const {
  print_matrix(out);
  std::map<std::string, std::set<std::string>> reasons;
  for (const Cell& cell : cells_) {
    if (cell.not_supported != nullptr) {
      reasons[cell.not_supported->reason()].insert(cell.result.run.scenario);
    }
    for (const ListEntry* entry : cell.expected) {
      reasons[entry->reason()].insert(cell.result.run.scenario + " " + entry->place());
    }
  }
  if (!reasons.empty()) out << "\nExpected to fail:\n";
  for (const auto& [reason, places] : reasons) {
    out << "  " << reason << ":";
    for (const std::string& place : places)
      out << " " << place << (place == *places.rbegin() ? "" : ",");
    out << "\n";
  }
  bool first = true;
  for (const Cell& cell : cells_) {
    const Run& run = cell.result.run;
    for (const Fault& fault : cell.faults) {
      if (std::exchange(first, false)) out << "\nFaults:\n";
      out << "  " << run.scenario << " " << run.version << " " << name_of(run.role)
          << (run.channel == "tcp" ? "" : " over " + run.channel) << ", " << fault.place
          << (fault.label.empty() ? "" : " (" + fault.label + ")") << ": " << fault.text << "\n";
    }
  }
  for (const std::string& stale : stale_entries()) out << "  " << stale << "\n";
  out << "\n" << summary() << "\n";
}

std::string Report::summary() const {
  std::map<Role, std::size_t> frames;
  std::map<Role, std::size_t> values;
  std::map<Role, std::size_t> replays;
  std::size_t refused = 0;
  std::size_t malformed = 0;
  std::size_t faults = 0;
  std::size_t expected = 0;
  std::set<const ListEntry*> deviations;
  for (const Cell& cell : cells_) {
    const Result& result = cell.result;
    const auto checked = static_cast<std::size_t>(result.checked);
    const bool codec = result.run.role == Role::decode || result.run.role == Role::encode;
    if (result.run.scenario == "values") {
      values[result.run.role] += checked;
    } else if (result.run.scenario == "malformed") {
      malformed += checked;
    } else if (codec) {
      frames[result.run.role] += checked;
    } else if (cell.not_supported == nullptr) {
      ++replays[result.run.role];
    }
    refused += static_cast<std::size_t>(result.refused);
    faults += cell.faults.size();
    expected += cell.expected.size() + (cell.not_supported != nullptr ? 1 : 0);
    deviations.insert(result.deviations.begin(), result.deviations.end());
  }
  faults += stale_entries().size();
  std::ostringstream text;
  text << language_ << ": " << frames[Role::decode] << " frames decoded and "
       << frames[Role::encode] << " encoded, " << values[Role::encode] << " values packed and "
       << refused << " refused, " << replays[Role::service] << " replays as service and "
       << replays[Role::client] << " as client, " << counted(malformed, "malformed input") << "; "
       << counted(expected, "expected failure") << ", " << counted(deviations.size(), "deviation")
       << "; "
       << (holds()       ? "all holds"
           : faults == 0 ? "nothing was played"
                         : counted(faults, "fault"));
  return text.str();
}

Json Report::json() const {
  Json cells = Json::array();
  for (const Cell& cell : cells_) {
    const Run& run = cell.result.run;
    Json json = {{"scenario", run.scenario}, {"version", run.version},
                 {"channel", run.channel},   {"role", name_of(run.role)},
                 {"outcome", outcome(cell)}, {"checked", cell.result.checked},
                 {"faults", Json::array()},  {"expected", Json::array()}};
    for (const Fault& fault : cell.faults) {
      json["faults"].push_back(
          {{"place", fault.place}, {"label", fault.label}, {"text", fault.text}});
    }
    if (cell.not_supported != nullptr) json["reason"] = cell.not_supported->reason();
    for (const ListEntry* entry : cell.expected) {
      json["expected"].push_back({{"place", entry->place()}, {"reason", entry->reason()}});
    }
    cells.push_back(std::move(json));
  }
  return {{"language", language_},
          {"cells", std::move(cells)},
          {"stale", stale_entries()},
          {"holds", holds()},
          {"summary", summary()}};
}

}  // namespace rr::conformance
