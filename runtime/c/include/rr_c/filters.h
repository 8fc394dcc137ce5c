/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_FILTERS_H
#define RR_C_FILTERS_H

/** @file
 * Which services a subscription is for (minor version 3). Included by rr.h. */

#include "discovery.h"

#ifdef __cplusplus
extern "C" {
#endif

/** How the answers of several tests make one. Of no tests, ALL and ANY hold, the others do not. */
enum {
  RR_MATCH_DEFAULT = 0, /**< said beside each field */
  RR_MATCH_ANY = 1,     /**< at least one of them holds */
  RR_MATCH_ALL = 2,     /**< each of them holds */
  RR_MATCH_NONE = 3,    /**< none of them holds */
  RR_MATCH_NOT_ALL = 4  /**< at least one of them does not hold */
};

/** One test of an attribute's texts. A text with commas is several texts; lists hold their items'
 * texts; other values have none. A missing attribute is as an empty list. */
typedef struct rr_attribute_test {
  rr_str value; /**< the text, or the expression, that a text must be */
  rr_str name;  /**< in an attribute that is a map: which of its values; empty: all */
  /** 1: the value is a regular expression (ECMAScript) for the whole text. */
  uint32_t is_expression;
  uint32_t reserved; /**< 0 */
} rr_attribute_test;

/** Tests of one attribute, and groups of such tests. */
typedef struct rr_attribute_group {
  rr_str attribute;                        /**< only in the filter itself, each once */
  const rr_attribute_test* tests;          /**< of the attribute's texts */
  size_t test_count;                       /**< of `tests` */
  const struct rr_attribute_group* groups; /**< up to 16 deep */
  size_t group_count;                      /**< of `groups` */
  uint32_t match;                          /**< RR_MATCH_...; default: ANY */
  uint32_t keeps_commas;                   /**< 1: a text with commas is one text */
} rr_attribute_group;

/** A node whose services are wanted, and the user to log in with. */
typedef struct rr_node_filter {
  rr_node_id id;           /**< zero: any */
  rr_str name;             /**< empty: any */
  rr_str username;         /**< empty: as the subscription's options say; otherwise as there */
  rr_str password;         /**< of `username` */
  rr_elements credentials; /**< instead of the password, unless count is 0 */
} rr_node_filter;

/** All that is filled in must hold. */
typedef struct rr_service_filter {
  size_t size;                          /**< sizeof(rr_service_filter), set by the caller */
  const rr_node_filter* nodes;          /**< one of these; the first that fits says who logs in */
  size_t node_count;                    /**< of `nodes`; 0: any node */
  const rr_str* service_names;          /**< one of these */
  size_t service_name_count;            /**< of `service_names`; 0: any */
  const rr_str* transport_schemes;      /**< `rr+tcp`, ...: URLs of others are not tried */
  size_t transport_scheme_count;        /**< of `transport_schemes`; 0: all */
  const rr_attribute_group* attributes; /**< tests of attributes, by `attributes_match` */
  size_t attribute_count;               /**< of `attributes` */
  uint32_t attributes_match;            /**< RR_MATCH_...; default: ALL */
  uint32_t reserved;                    /**< 0 */
  size_t max_connections;               /**< at a time; 0: any number */
  void* context;                        /**< passed to the functions below */
  /** Has the last word: 1 for a service that is wanted. May be called for several at once. */
  int32_t (*predicate)(void* context, const rr_found_service* service);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
} rr_service_filter;

#ifdef __cplusplus
}
#endif

#endif
