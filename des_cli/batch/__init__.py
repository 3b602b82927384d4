"""Many profiles: jobs as plain data, a runner over an Executor, and a pool of this machine."""
