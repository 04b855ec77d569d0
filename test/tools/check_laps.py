"""check_laps.py REPORT REPORT_OF_FEW_LAPS: of `landfix replay --loop N --json`; fails where laps leave traces."""

import json
import sys

report, few = (json.load(open(path, encoding="utf-8")) for path in sys.argv[1:3])
# null where a sanitizer owns the heap
untouched = all(report[key] in (0, None) for key in ("heap_calls", "locks", "page_faults", "lost"))
nothing_dropped = report["packets"]["dropped"] == 0 and report["sweeps_skipped"] == 0
memory_constant = report["rss_mib"] <= few["rss_mib"] + 1.0
print(
    f"{report['sweeps']} sweeps, {report['tracked']} tracked, {report['lost']} lost; {report['heap_calls']} heap calls, "
    f"{report['locks']} locks, {report['page_faults']} page faults; {report['rss_mib']:.1f} MiB"
)
sys.exit(0 if untouched and nothing_dropped and memory_constant else 1)
