# SPDX-License-Identifier: BSD-3-Clause
"""What a lab would use instead of the framework."""
