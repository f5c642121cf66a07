#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# xacro 2.1.1 does not compute a property whose value is written as a quotient: ${d} of the
# property "1/2" is the text 1/2, while ${1/2} is 0.5. Seen: 1/2 and 0.5. So the audit reads
# numbers of a description only after xacro, and names the place of a text that is no number.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install -q xacro==2.1.1
cd "$folder"
env/bin/python - <<'PYTHON'
import xacro

document = xacro.parse(
    '<robot xmlns:xacro="http://wiki.ros.org/xacro"><xacro:property name="d" value="1/2"/>'
    '<a v="${d}"/><b v="${1/2}"/></robot>'
)
xacro.process_doc(document)
values = [node.getAttribute("v") for node in document.documentElement.childNodes]
print("xacro", values)
assert values == ["1/2", "0.5"]
PYTHON
