# SPDX-License-Identifier: BSD-3-Clause
"""Trials, verdicts, reports, replays and demonstrations of the adaptive skill framework."""
