"""Logs and tables of a fleet in stores that other people wrote, against files: `fleet_from_stores.py PROGRAM FOLDER`.

S3 as moto speaks it, Azure Blob Storage as Azurite does (where `azurite` is a program), and HTTPS by Python's own server: with the
certificate of an authority that is known, of one that is not, and of another host. FOLDER is for what is written.
"""

from __future__ import annotations

import functools
import http.server
import json
import os
import shutil
import socket
import ssl
import subprocess
import sys
import threading
import time
from pathlib import Path

from fleet_on_engines import ROOT, rows

#: account of Azurite, as its documentation has it
ACCOUNT = "devstoreaccount1"
NAMES = {"a.ulg": "px4_flight.ulg", "deep/b.tlog": "p04_identify_10_22s.tlog"}


def logs(at: Path) -> None:
    (at / "deep").mkdir(parents=True)
    for name, fixture in NAMES.items():
        shutil.copy(ROOT / "fixtures" / fixture, at / name)
    whole = (at / "a.ulg").read_bytes()
    (at / "cut.ulg").write_bytes(whole[: len(whole) // 3])
    (at / "words.bin").write_bytes(b"this is no log at all\n" * 50)


def fleet(program: str, *words: object, **variables: str) -> subprocess.CompletedProcess[str]:
    command = [program, "fleet", *map(str, words)]
    environment = {**os.environ, "NO_PROXY": "localhost,127.0.0.1", **variables}
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


def moved(tables: dict[str, list[str]], from_: str) -> dict[str, list[str]]:
    """The rows without the addresses of their logs. What is said of a log has its address as well."""
    return {name: sorted(row.replace(from_, "logs") for row in own) for name, own in tables.items()}


def free_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def wait_for(port: int) -> None:
    for _ in range(300):
        try:
            return socket.create_connection(("127.0.0.1", port), timeout=1).close()
        except OSError:
            time.sleep(0.1)
    raise AssertionError(f"nothing listens at port {port}")


def same(expected: dict[str, list[str]], found: dict[str, list[str]], store: str) -> None:
    assert expected == found, f"{store}: {[name for name in expected if expected[name] != found.get(name)]}"
    print(f"{store}: {sum(map(len, found.values()))} rows, equal to those of files")


def of_store(program: str, folder: Path, store: str, sources: list[str], **variables: str) -> dict[str, list[str]]:
    out = folder / store
    run = fleet(program, *sources, "--out", out, "--depth", "balance", "--quiet", **variables)
    assert run.returncode == 3, (store, run.returncode, run.stdout, run.stderr)
    return rows(out)


def s3(program: str, at: Path, folder: Path, expected: dict[str, list[str]]) -> None:
    import boto3
    from moto.server import ThreadedMotoServer

    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    endpoint = "http://{}:{}".format(*server.get_host_and_port())
    keys = {"AWS_ACCESS_KEY_ID": "key", "AWS_SECRET_ACCESS_KEY": "secret", "AWS_REGION": "us-east-1"}
    client = boto3.client("s3", endpoint_url=endpoint, region_name="us-east-1", aws_access_key_id="key", aws_secret_access_key="secret")
    for bucket in ("flights", "tables"):
        client.create_bucket(Bucket=bucket)
    for path in at.rglob("*.*"):
        client.upload_file(str(path), "flights", f"2026/{path.relative_to(at)}")
    variables = {"AWS_ENDPOINT": endpoint, "AWS_ALLOW_HTTP": "true", **keys}
    same(expected, moved(of_store(program, folder, "s3", ["s3://flights/2026"], **variables), "s3://flights/2026"), "s3")
    run = fleet(program, "s3://flights/2026", "--out", "s3://tables/run", "--depth", "balance", "--quiet", **variables)
    assert run.returncode == 3, (run.stdout, run.stderr)
    copy = folder / "s3_tables"
    for found in client.list_objects_v2(Bucket="tables")["Contents"]:
        path = copy / found["Key"].removeprefix("run/")
        path.parent.mkdir(parents=True, exist_ok=True)
        client.download_file("tables", found["Key"], str(path))
    same(expected, moved(rows(copy), "s3://flights/2026"), "tables in s3")
    server.stop()


def az(program: str, at: Path, folder: Path, expected: dict[str, list[str]]) -> None:
    from azure.storage.blob import BlobServiceClient
    from azure.storage.blob._shared.parser import DEVSTORE_ACCOUNT_KEY

    port = free_port()
    azurite = os.environ.get("AZURITE") or shutil.which("azurite-blob")
    if azurite is None:
        return print("az: skipped, there is no azurite-blob (npm install azurite)")
    command = [azurite, "--blobHost", "127.0.0.1", "--blobPort", str(port), "--inMemoryPersistence", "--silent", "--skipApiVersionCheck", "--disableTelemetry"]
    process = subprocess.Popen(command, cwd=folder)
    try:
        wait_for(port)
        service = BlobServiceClient.from_connection_string(
            f"DefaultEndpointsProtocol=http;AccountName={ACCOUNT};AccountKey={DEVSTORE_ACCOUNT_KEY};"
            f"BlobEndpoint=http://127.0.0.1:{port}/{ACCOUNT};"
        )
        for container in ("flights", "tables"):
            service.create_container(container)
        for path in at.rglob("*.*"):
            service.get_blob_client("flights", f"2026/{path.relative_to(at)}").upload_blob(path.read_bytes())
        variables = {"AZURE_STORAGE_USE_EMULATOR": "true", "AZURITE_BLOB_STORAGE_URL": f"http://127.0.0.1:{port}"}
        same(expected, moved(of_store(program, folder, "az", ["az://flights/2026"], **variables), "az://flights/2026"), "az")
        run = fleet(program, "az://flights/2026", "--out", "az://tables/run", "--depth", "balance", "--quiet", **variables)
        assert run.returncode == 3, (run.stdout, run.stderr)
        copy = folder / "az_tables"
        container = service.get_container_client("tables")
        for name in container.list_blob_names():
            path = copy / name.removeprefix("run/")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(container.download_blob(name).readall())
        same(expected, moved(rows(copy), "az://flights/2026"), "tables in az")
    finally:
        process.terminate()
        process.wait()


def https(program: str, at: Path, folder: Path, expected: dict[str, list[str]]) -> None:
    import trustme

    authority, other = trustme.CA(), trustme.CA()
    trusted = folder / "authority.pem"
    authority.cert_pem.write_to_path(str(trusted))
    sources = lambda host, port: [f"https://{host}:{port}/{path.relative_to(at)}" for path in sorted(at.rglob("*.*"))]

    def serve(of: trustme.CA, name: str) -> int:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        of.issue_cert(name).configure_cert(context)
        handler = functools.partial(Quiet, directory=str(at))
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        server.socket = context.wrap_socket(server.socket, server_side=True)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        return server.server_port

    port = serve(authority, "localhost")
    given = {"SSL_CERT_FILE": str(trusted)}
    found = of_store(program, folder, "https", sources("localhost", port), **given)
    same(expected, moved(found, f"https://localhost:{port}"), "https")
    for why, port in [("another authority", serve(other, "localhost")), ("another host", serve(authority, "elsewhere"))]:
        begun = time.monotonic()
        run = fleet(program, sources("localhost", port)[0], "--out", folder / "refused", **given)
        print(f"https, {why}: status {run.returncode} after {time.monotonic() - begun:.1f} s: {run.stderr.strip()}")
        assert run.returncode == 2 and "certificate" in run.stderr, (run.returncode, run.stderr)


class Quiet(http.server.SimpleHTTPRequestHandler):
    """Files, without a word."""

    def log_message(self, format: str, *args: object) -> None:
        pass


def main() -> None:
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    at = folder / "logs"
    logs(at)
    run = fleet(program, at, "--out", folder / "local", "--depth", "balance", "--quiet")
    assert run.returncode == 3, (run.returncode, run.stdout, run.stderr)
    expected = moved(rows(folder / "local"), str(at))
    assert len(expected["logs"]) == 4, json.dumps(expected["logs"])
    for store in (s3, az, https):
        store(program, at, folder, expected)


if __name__ == "__main__":
    main()
