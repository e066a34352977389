#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A remote cache that is at fault in the way that the first part of a path says: GET and PUT of
/FAULT/ac/KEY and /FAULT/cas/DIGEST. All faults share what was put, so that what was put through one can be got
through another.

    faulty_server.py        prints its port; ends when its standard input does

GET /count/FAULT is the number of requests that this fault has had.
"""
import collections
import http.server
import sys
import threading

stored = {}  # by the path below the fault, "ac/..."
counts = collections.Counter()
lock = threading.Lock()
ended = threading.Event()
PAGE = b"<!DOCTYPE html><html><title>Sign in</title><p>Please sign in to the network.</html>"


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def log_message(self, *_):
        pass

    def answer(self, status, body=b"", length=None, **headers):
        self.send_response(status)
        self.send_header("Content-Length", str(len(body) if length is None else length))
        for name, value in headers.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)
        if length is not None:
            self.close_connection = True

    def part(self):
        _, fault, place = self.path.split("/", 2)
        with lock:
            counts[fault] += 1
        return fault, place

    def do_GET(self):
        fault, place = self.part()
        if fault == "count":
            self.answer(200, str(counts[place]).encode())
            return
        kind = place.split("/")[0]
        with lock:
            body = stored.get(place)
            others = [value for key, value in stored.items() if key.startswith(kind + "/") and key != place]
        # "ac-short" is short for entries and good for outputs.
        only, _, of_kind = fault.partition("-")
        if only in ("ac", "cas"):
            fault = of_kind if only == kind else "good"
        answer = getattr(self, "get_" + fault, None)
        if answer:
            answer(body, others)
        elif fault.isdigit() and int(fault) != 507:
            self.answer(int(fault), b"no")
        elif body is None:
            self.answer(404)
        else:
            self.answer(200, body)

    def get_html(self, _body, _others):
        self.answer(200, PAGE)

    def get_redirect(self, _body, _others):
        self.answer(302, Location="/good/" + self.path.split("/", 2)[2])

    def get_empty(self, _body, _others):
        self.answer(200)

    def get_short(self, body, _others):
        self.answer(200, (body or PAGE)[:-1], length=len(body or PAGE))

    # As of a server whose file is half of what it was: the length is that of what is sent.
    def get_half(self, body, _others):
        body = body or PAGE
        self.answer(200, body[:len(body) // 2])

    def get_long(self, body, _others):
        self.answer(200, (body or PAGE) + b"x")

    def get_wrong(self, body, _others):
        body = bytearray(body or PAGE)
        body[len(body) // 2] ^= 1
        self.answer(200, bytes(body))

    def get_other(self, _body, others):
        self.answer(200, others[0] if others else PAGE)

    def get_slow(self, _body, _others):
        ended.wait()
        self.close_connection = True

    # Slower than is worth while, and never done.
    def get_drip(self, body, _others):
        self.send_response(200)
        self.send_header("Content-Length", str(len(body or PAGE) + 10 ** 6))
        self.end_headers()
        while not ended.wait(0.1):
            self.wfile.write(b"x")

    def get_endless(self, _body, _others):
        self.send_response(200)
        self.end_headers()
        self.close_connection = True
        try:
            while not ended.is_set():
                self.wfile.write(b"x" * 65536)
        except OSError:
            pass

    def get_closes(self, _body, _others):
        self.close_connection = True

    def get_garbage(self, _body, _others):
        self.wfile.write(b"\x00\x01no HTTP\r\n\r\n")
        self.close_connection = True

    def do_PUT(self):
        fault, place = self.part()
        if fault == "slow":
            ended.wait()
            return
        if fault == "closes":
            self.close_connection = True
            return
        if fault == "early413":  # before the body is read
            self.answer(413, b"no")
            self.close_connection = True
            return
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if fault.isdigit():
            self.answer(int(fault), b"no")
            return
        if fault == "half":
            body = body[:len(body) // 2]
        with lock:
            stored[place] = body
        if fault == "loses":
            with lock:
                del stored[place]
        self.answer(201)


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True

    def handle_error(self, *_):
        pass  # a client that has heard enough


def main():
    server = Server(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    print(server.server_port, flush=True)
    sys.stdin.read()
    ended.set()


if __name__ == "__main__":
    main()
