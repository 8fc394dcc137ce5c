#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Answers with the options that it was given.
options=$(sed 's/.*"options":{\([^}]*\)}.*/\1/; s/"/\\"/g')
printf '%s\n' "{\"files\":[{\"path\":\"options.txt\",\"content\":\"first $options\"}]}"
