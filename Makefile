# Every recipe stands alone on a fresh machine: set-up comes first and does nothing the second time.

.PHONY: help setup demo test check check-long bench
.DEFAULT_GOAL := help

help:
	@echo 'make demo        build, generate a furnished two-room scene and solve it'
	@echo 'make test        the tests'
	@echo 'make check       the whole gate: format, lints, tests, documentation, licences'
	@echo 'make check-long  what takes too long for every change'
	@echo 'make bench       Embree packet benchmarks (bench/)'
	@echo 'make setup       only bring what the build needs'

setup:
	@./setup.sh

demo: setup
	cargo build --release
	cargo run --release --quiet -- generate two-rooms --out demo
	cargo run --release --quiet -- solve demo/two-rooms.obj --out demo/solved

test: setup
	cargo test

check:
	@./setup.sh --check
	cargo fmt --check
	cargo clippy --all-targets --all-features -- --deny warnings
	cargo test
	RUSTDOCFLAGS='--deny warnings' cargo doc --no-deps
	cargo deny check licenses bans sources

# Tests marked `ignored` take minutes each.
check-long: setup
	cargo test -- --ignored

bench: setup
	cargo bench --features c-baseline --bench embree_packets
