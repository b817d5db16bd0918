#!/usr/bin/env python3
"""Counts a ctest JUnit report; the last line printed is `N passed, N failed`.

usage: count_tests.py REPORT CTEST_EXIT_CODE

A test that could not be started is a failure, also where ctest calls it "not run".
"""

import os
import sys
import xml.etree.ElementTree as xml


def main(report, ctest_code):
    passed, failed, skipped = 0, [], []
    if os.path.exists(report):
        for case in xml.parse(report).getroot().iter("testcase"):
            status, name = case.get("status"), case.get("name")
            reason = case.find("skipped")
            if status == "run":
                passed += 1
            elif status == "disabled" or (
                reason is not None and reason.get("message", "").startswith("SKIP_")
            ):
                skipped.append(name)
            else:
                failed.append(name)
    count = len(failed)
    if ctest_code != 0 and count == 0:
        print(f"ctest itself failed with exit code {ctest_code}")
        count = 1
    for name in failed:
        print(f"failed: {name}")
    for name in skipped:
        print(f"skipped: {name}")
    if passed + count == 0:
        print("no test was run")
    print(f"{passed} passed, {count} failed", flush=True)
    return 0 if count == 0 and passed > 0 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2])))
