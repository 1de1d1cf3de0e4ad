# SPDX-License-Identifier: BSD-3-Clause
"""Messages of the framework, the table of its topics and the names of its enumerations."""
