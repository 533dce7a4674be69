"""Messages as they come, where LCM's Python module is there; Debian 12 has none, and logs need none (event_log)."""

import os

URL = "udpm://239.255.76.67:7667?ttl=0"


def subscribe(channels, handler, url=None):
    """Calls handler(channel, data) for each message whose whole channel name matches the regular expression, for ever.
    `url`: default $LCM_DEFAULT_URL, else udpm with ttl=0. Of each channel the newest message is kept while the handler works.
    Raises ImportError, with what helps, where the lcm module is missing."""
    try:
        import lcm
    except ImportError as error:
        raise ImportError(
            "no Python module 'lcm': `python3 -m venv --system-site-packages ~/lcm && ~/lcm/bin/pip install lcm` makes a "
            "Python that has it, ~/lcm/bin/python; logs need none (houghstream.event_log)"
        ) from error
    bus = lcm.LCM(url or os.environ.get("LCM_DEFAULT_URL") or URL)
    # LCM puts ^ and $ around it, which would belong to the first and the last alternative only.
    bus.subscribe(f"({channels})", handler).set_queue_capacity(1)
    while True:
        bus.handle()
