"""The chart of a long run: what each process takes, and how long frames take, over its minutes."""

from matplotlib.figure import Figure

TAKEN = (("mb", "resident memory, MB"), ("descriptors", "descriptors"), ("threads", "threads"))


def draw(samples, latency, file):
    """`latency`: of long_account.latencies(), empty where nothing was observed."""
    figure = Figure(figsize=(9, 12), layout="constrained")
    axes = figure.subplots(len(TAKEN) + 1, 1, sharex=True)
    for axis, (key, label) in zip(axes, TAKEN):
        for name, of_process in samples.items():
            axis.plot([one["s"] / 60 for one in of_process], [one[key] for one in of_process], label=f"hs-{name}")
        axis.set_ylabel(label)
    axes[0].legend()
    for number, (result, whole) in enumerate(latency.items()):
        for part, style in (("p50", ".-"), ("p99", ".--")):
            axes[-1].plot([one["minute"] + 0.5 for one in whole["minutes"]], [one[part] for one in whole["minutes"]], style,
                          color=f"C{number}", label=f"frame to {result}, {part}")  # fmt: skip
    axes[-1].set_ylabel("latency of each minute, ms")
    axes[-1].set_xlabel("minutes")
    if latency:
        axes[-1].legend()
    for axis in axes:
        axis.set_ylim(bottom=0)
    figure.savefig(file, dpi=110)
