"""
Ask a server
============

How do I ask a running service from a program? ``rocking serve`` starts a service, ``make serve`` one with the data
sets. The client needs the standard library only.
"""

import csv
import io
import json
import os
from urllib.parse import urlencode
from urllib.request import Request, urlopen

server = os.environ.get("ROCKING_SERVER", "http://127.0.0.1:8000")

# %%
# One block in metres. Each answer has its thresholds, margins and warnings.

question = {
    "pulse": "sine",
    "width": 0.4,  # m
    "height": 1.6,  # m
    "peak_acceleration": 0.45 * 9.80665,  # m/s2
    "period": 0.5,  # s
}
with urlopen(f"{server}/v1/blocks/response?{urlencode(question)}") as reply:
    answer = json.load(reply)
for name in ("meaning", "peak_rotation_deg", "displacement", "thresholds", "margins", "warnings"):
    print(f"{name}: {answer[name]}")

# %%
# Many blocks in groups, as CSV in and CSV out.

table = "slenderness,frequency_ratio,restitution\n0.4,5,0.85\n0.2,5,0.85\n0.2,9,0.85\n"
request = Request(
    f"{server}/v1/response?pulse=sine",
    data=table.encode(),
    headers={"Content-Type": "text/csv"},
)
with urlopen(request) as reply:
    for row in csv.DictReader(io.TextIOWrapper(reply, encoding="utf-8")):
        print(row["outcome"], row["peak_rotation"])

# %%
# The answer to a wrong question names the parameter, its value and what is allowed (RFC 9457).

try:
    urlopen(f"{server}/v1/response?pulse=sine&slenderness=0.4&frequency_ratio=5&restitution=1.85")
except OSError as error:
    print(json.load(error)["detail"])
