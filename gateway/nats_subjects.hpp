// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Topics as subjects of NATS: `rr/hall/robot/$life` is `rr.hall.robot.$life`. Letters of a level
/// that a subject cannot have, or could read as something else, are `~XX` in hexadecimal: `.`, `*`,
/// `>`, `~`, spaces and control characters. An empty level is `~`. Two topics never have the same
/// subject.
namespace rr::gateway {

/// The subject of a topic.
std::string subject_of(std::string_view topic);
/// The reverse; nothing for a subject that subject_of() does not make.
std::optional<std::string> topic_of(std::string_view subject);
/// What to subscribe to for a filter of topics: two subjects where it ends with `#`, which fits the
/// levels before it as well.
std::vector<std::string> subjects_of_filter(std::string_view filter);

/// Where the stream of retained messages takes the message of a subject: `rrkept.hall...` for
/// `rr.hall...`. Nothing for a subject that is not below `rr`.
std::optional<std::string> kept_subject(std::string_view subject);
/// The reverse.
std::optional<std::string> subject_of_kept(std::string_view kept);

/// The topic of the beats of a life: a level below it.
std::string beat_topic(std::string_view life_topic);
/// The life of a topic of beats; nothing for another topic.
std::optional<std::string> life_of_beats(std::string_view topic);
/// Whether a topic or filter is that of lives: its last level is `$life`.
bool is_life_topic(std::string_view topic);

/// Where the answers to a user of the broker go that are for the carrier itself. Access lists give
/// each user this one.
std::string inbox_prefix(std::string_view user);

}  // namespace rr::gateway
