/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_C_SECURITY_H
#define RR_C_SECURITY_H

/** @file
 * Encrypted connections, and a record of what clients do (minor version 4). Included by rr.h. */

#include "values.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A node that is trusted for its certificate alone, signed by any authority. */
typedef struct rr_pin {
  rr_node_id node; /**< whose certificate it is */
  rr_str sha256;   /**< of the certificate, 64 hexadecimal digits */
} rr_pin;

/** As rr::TlsOptions (docs/explanation/security.md). Files are looked at again while the node runs.
 */
typedef struct rr_tls_options {
  size_t size;             /**< sizeof(rr_tls_options), set by the caller */
  rr_str certificate_file; /**< PEM or .p12, of which the node takes its id; empty: none */
  rr_str key_file;         /**< PEM; empty: in the same file */
  /** certificates, PEM, of the authorities that are trusted, besides those that the environment
   * names */
  const rr_str* authority_files;
  size_t authority_file_count; /**< of `authority_files` */
  /** lists, PEM, of the certificates that authorities have revoked */
  const rr_str* revocation_files;
  size_t revocation_file_count;    /**< of `revocation_files` */
  const rr_pin* pins;              /**< nodes that are trusted without an authority */
  size_t pin_count;                /**< of `pins` */
  uint32_t is_required;            /**< 1: nothing but TLS, in both directions */
  uint32_t must_certify_clients;   /**< 1: clients that use TLS prove which node they are */
  uint32_t system_authorities;     /**< RR_AUTHORITIES_..., for hosts of rr+wss */
  uint32_t accepts_outdated_lists; /**< 1: lists of revoked certificates that have run out */
  int32_t look_again_period_ms;    /**< 0: 5 s; RR_NO_LIMIT: at new connections only */
  uint32_t reserved;               /**< 0 */
} rr_tls_options;

/** Which authorities vouch for the host of a `rr+wss` URL. */
enum {
  RR_AUTHORITIES_UNLESS_GIVEN = 0, /**< those of the system where no authority file is given */
  RR_AUTHORITIES_OF_SYSTEM = 1,    /**< those of the system, and those that are given */
  RR_AUTHORITIES_GIVEN = 2         /**< never those of the system */
};

/** Who connects, logs in, and is refused (docs/howto/access.md), as lines of JSON: to a file, to a
 * function, or to both. */
typedef struct rr_audit_options {
  size_t size;   /**< sizeof(rr_audit_options), set by the caller */
  rr_str file;   /**< which only its owner may read; empty: none */
  void* context; /**< passed to the functions below */
  /** A line without its end. On any thread, for several events at once. */
  void (*on_event)(void* context, rr_str line);
  void (*drop)(void* context); /**< last of all, once; see rr.h */
  uint64_t max_size;           /**< a file that would become larger is renamed; bytes, 0: 16 MiB */
  uint32_t kept_files;         /**< of those; 0: five */
  uint32_t requests;           /**< 1: handled requests, too */
  uint64_t refusals;           /**< of a session in ten seconds, others are counted; 0: 50 */
} rr_audit_options;

#ifdef __cplusplus
}
#endif

#endif
