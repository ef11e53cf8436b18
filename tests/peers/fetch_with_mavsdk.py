"""Fetches a log with MAVSDK, by log messages and by the file transfer.

    fetch_with_mavsdk.py CONNECTION FOLDER

Writes {"entries": sizes by the log messages, "log": file that these brought, "ftp": file by the file transfer, "path": of
it on the vehicle} as JSON. Exit status 77 where MAVSDK is missing.
"""

import json
import os
import sys
import threading

try:
    import mavsdk
    from mavsdk.plugins.ftp import Ftp, FtpResult
    from mavsdk.plugins.log_files import LogFiles, LogFilesResult
except (ImportError, OSError):
    sys.stderr.write("mavsdk is missing\n")
    sys.exit(77)

PATIENCE_S = 60.0


def until_done(begin, going_on, success):
    """Begins a download and waits until it is over."""
    over, results = threading.Event(), []

    def told(result, _progress, _user_data):
        if result != going_on:
            results.append(result)
            over.set()

    begin(told)
    if not over.wait(PATIENCE_S):
        raise SystemExit("no end of the download")
    if results[0] != success:
        raise SystemExit(f"the download ends with {results[0]!r}")


def last(ftp, path):
    """Path of the last log below a folder."""
    listed = ftp.list_directory(path)
    listed = listed[1] if isinstance(listed, tuple) else listed
    entry = sorted((entry for entry in listed.entries if entry.name.strip(".")), key=lambda entry: entry.name)[-1]
    below = f"{path}/{entry.name}"
    return last(ftp, below) if entry.entry_type == entry.EntryType.DIRECTORY else below


def main():
    # the library writes to standard output: that is for the answer alone
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    connection, folder = sys.argv[1:]
    configuration = mavsdk.Configuration.create_with_component_type(mavsdk.ComponentType.GROUND_STATION)
    library = mavsdk.Mavsdk(configuration)
    if library.add_any_connection(connection) != mavsdk.ConnectionResult.SUCCESS:
        raise SystemExit(f"{connection} cannot be opened")
    system = library.first_autopilot(20.0)
    if system is None:
        raise SystemExit("no vehicle came")
    logs = LogFiles(system)
    entries = logs.get_entries()
    entries = entries[1] if isinstance(entries, tuple) else entries
    log = os.path.join(folder, "by_messages")
    until_done(lambda told: logs.download_log_file_async(entries[-1], log, told),
               LogFilesResult.NEXT, LogFilesResult.SUCCESS)
    ftp = Ftp(system)
    path = last(ftp, "/fs/microsd/log")
    until_done(lambda told: ftp.download_async(path, folder, True, told), FtpResult.NEXT, FtpResult.SUCCESS)
    json.dump({
        "entries": [entry.size_bytes for entry in entries],
        "log": log,
        "ftp": os.path.join(folder, os.path.basename(path)),
        "path": path,
    }, answer)
    answer.close()
    os._exit(0)


main()
