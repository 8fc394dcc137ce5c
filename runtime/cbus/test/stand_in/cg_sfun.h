/* SPDX-License-Identifier: Apache-2.0
 * What ends a block: our stand-in needs nothing here, the test calls the block's functions itself. */
