"""Many small processes that compile: forks of one that has imported numba and prepared its compiler."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

FORKS = """
import json, os, sys, traceback
import numba
import numpy as np
numba.njit(lambda values: values[0] + len(values))(np.ones(2))
for line in sys.stdin:
    code, variables = json.loads(line)
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.dup2(write, 1)
        os.dup2(write, 2)
        os.close(write)
        os.environ.update(variables)
        status = 0
        try:
            exec(code, {"__name__": "__main__"})
        except BaseException:
            traceback.print_exc()
            status = 1
        sys.stdout.flush()
        os._exit(status)
    os.close(write)
    with open(read, encoding="utf-8") as output:
        text = output.read()
    print(json.dumps([os.waitpid(child, 0)[1], text]), flush=True)
"""
"""Runs code and returns its status and output. The package is not imported before the fork."""


@pytest.fixture(scope="package")
def fork():
    """Run code in a process of its own, with variables of its environment, and return what it prints.

    A new process takes two seconds until its first function is compiled, such a fork a fifth of a second.
    """
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with subprocess.Popen([sys.executable, "-c", FORKS], env=environment, **pipes) as process:

        def run(code, **variables):
            process.stdin.write(json.dumps([code, variables]) + "\n")
            process.stdin.flush()
            status, output = json.loads(process.stdout.readline())
            assert status == 0, output
            return output

        yield run
        process.stdin.close()
