"""What every node of the suite shares: parameters, command line, start, callbacks, signals, quality of service."""
