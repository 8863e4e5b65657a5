"""What is written to a connection, and when it is sent."""

import asyncio

from rocking_api.http.coalescing import OneWrite


class Transport:
    def __init__(self):
        self.sent = []

    def write(self, data):
        self.sent.append(data)

    def writelines(self, pieces):
        self.sent.append(b"".join(pieces))

    def close(self):
        self.sent.append("closed")

    def get_write_buffer_size(self):
        return 0

    def is_closing(self):
        return "closed" in self.sent


def sent(*steps):
    """What has left after the steps, and after a turn of the loop."""

    async def scenario():
        transport = Transport()
        wrapped = OneWrite(transport, asyncio.get_running_loop(), 1.0)
        for step in steps:
            step(wrapped)
        at_once = [*transport.sent]
        await asyncio.sleep(0)
        return at_once, transport.sent

    return asyncio.run(scenario())


def write(data):
    return lambda transport: transport.write(data)


def test_head_and_body_leave_as_one():
    assert sent(write(b"head "), write(b"body")) == ([b"head body"], [b"head body"])


def test_a_head_alone_leaves_when_the_loop_turns():
    assert sent(write(b"head")) == ([], [b"head"])


def test_nothing_is_lost_or_changes_places():
    _, left = sent(*map(write, [b"1", b"2", b"3", b"4", b"5"]))
    assert b"".join(left) == b"12345"


def test_what_was_written_leaves_before_the_end():
    assert sent(write(b"head"), OneWrite.close) == ([b"head", "closed"], [b"head", "closed"])


def test_nothing_is_written_to_a_connection_that_was_lost():
    assert sent(write(b"head"), lambda one: one._transport.close()) == (["closed"], ["closed"])
